"""Effects that are not sought in means of blocks: in the noise, and in the quality of samples."""

from collections.abc import Iterator, Sequence
from typing import Any

from stages.inference.naming.named import FOUND, ONE_OF_CLASS
from stages.model.effect import Effect
from stages.notation.causes import in_words
from stages.notation.numbers import decimals_of, with_sigma
from stages.notation.units import DEGREE_PER_HOUR, MICRO_G

Row = dict[str, Any]

WALK = "gyro_random_walk"
SENSORS = {"gyro": "triad of gyros", "accel": "triad of accelerometers"}
UNITS = {"gyro": "rad/s/√s", "accel": "m/s²/√s"}
SHARED = {"gyro": ("earth", "latitude", "heading"), "accel": ("lever", "size", "table")}
ELSEWHERE = {
    "gyro_flicker": "In one campaign it is not told from a random walk, which is estimated.",
    "table_position_error": "Each position has tilts of its own, with the sigma of the table; one"
    " that does not fit is a finding of the accelerometers.",
    "table_ripple": "The steady parts are searched for lines in time; none in the table's angle"
    " is looked for yet.",
    "table_eccentricity": "The steady parts are searched for lines in time; none in the table's"
    " angle is looked for yet.",
}


def scores(effects: Sequence[Effect], walk: Row | None) -> Iterator[Row]:
    """One row for each; `walk`: the row of the joint fit of the gyros, if there is one."""
    for effect in effects:
        found = effect.name == WALK and walk is not None and bool(walk["random_walk"])
        if found:
            assert walk is not None
            size = _walk("gyro", walk)
            told = f"The biases of the gyros walk by {size}, which the sigmas allow for."
        elif effect.sought_in == "quality":
            told = f"The quality of the samples tells it: findings “{in_words(effect.finding)}”."
        else:
            told = ELSEWHERE.get(effect.name, "The data ask for none.")
        yield {
            "effect": effect.name,
            "cause": effect.cause,
            "sought_in": effect.sought_in,
            "statistic": 0.0,
            "degrees": 1 if effect.name == WALK and walk is not None else 0,
            "p_value": 0.0 if found else 1.0,
            "named": found,
            "verdict": FOUND if found else "",
            "members": effect.name if found else "",
            "snr": None,
            "at": None,
            "sentence": told,
        }


def findings(sensor: str, walk: Row, instead: Sequence[str], suffix: str) -> Iterator[Row]:
    """The random walk of a sensor, `gyro` or `accel`, with the effects that may be it instead."""
    cause = f"{sensor}_random_walk"
    others = [name for name in instead if name.startswith((sensor, *SHARED[sensor]))]
    told = f"The {SENSORS[sensor]} has a random walk of its biases: {_walk(sensor, walk)}."
    if others:
        names = " or ".join(in_words(name) for name in others)
        told += f" Instead it may be {names}: this campaign cannot tell them apart."
    value, sigma = walk["random_walk"], walk["random_walk_sigma"] or 0.0
    yield {
        "id": f"criticism/{cause}{suffix}",
        "cause": cause,
        "sensor": sensor,
        "count": 1,
        "size": float(value),
        "unit": UNITS[sensor],
        "severity": 1,
        "sentence": told,
        "consequence": "The sigmas of all parameters allow for it.",
        "action": "Record the positions once more, in another order, to tell a walk from others."
        if others
        else "A shorter campaign, or turns there and back, lessen what it does.",
        "verdict": ONE_OF_CLASS if others else FOUND,
        "members": ", ".join([cause, *others]),
        "parameters": f"K = {value:.3g} ± {sigma:.2g} {UNITS[sensor]}",
    }


def _walk(sensor: str, walk: Row) -> str:
    # By K per √s a bias walks by 60 K in the root of an hour.
    size, unit = (DEGREE_PER_HOUR, "°/h") if sensor == "gyro" else (MICRO_G.size, "µg")
    both = (walk["random_walk"], walk["random_walk_sigma"])
    value, sigma = (float(one or 0.0) / size * 60 for one in both)
    return f"{' ± '.join(with_sigma(value, sigma, decimals_of(sigma)))} {unit}/√h"
