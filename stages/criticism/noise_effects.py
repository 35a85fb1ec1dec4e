"""Effects that are not sought in means of blocks: in the noise, and in the quality of samples."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.model_selection.cause import ONE_OF_CLASS, UNKNOWN_STRUCTURE
from inertial.physics.effect import Effect
from inertial.text.cause_names import in_words
from inertial.text.numbers import decimals_of, with_sigma
from inertial.text.units import DEGREE_PER_HOUR, MICRO_G
from stages.criticism.random_walks import Walk

Row = dict[str, Any]

WALK = "gyro_random_walk"
SENSORS = {"gyro": "gyros", "accel": "accelerometers"}
UNITS = {"gyro": "rad/s/√s", "accel": "m/s²/√s"}
SHARED = {"gyro": ("earth", "latitude", "heading"), "accel": ("lever", "size", "table")}
ELSEWHERE = {
    "gyro_flicker": "In one campaign it is not told from a random walk, which is estimated.",
}


def scores(effects: Sequence[Effect], walk: Walk | None) -> Iterator[Row]:
    """One row for each; `walk`: of the gyros, if there is one."""
    for effect in effects:
        found = effect.name == WALK and walk is not None
        if effect.name == WALK and walk is not None:
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
            "degrees": 1 if found else 0,
            "p_value": 0.0 if found else 1.0,
            "named": found,
            "verdict": UNKNOWN_STRUCTURE if found else "",
            "members": effect.name if found else "",
            "snr": None,
            "at": None,
            "sentence": told,
        }


def findings(
    sensor: str, walk: Walk, instead: Sequence[str], suffix: str, *, structured: bool
) -> Iterator[Row]:
    """The random walk of a sensor, `gyro` or `accel`, with the effects that may be it instead.

    With these it is one of a class. Without them it is never certain: what changes by no law, such
    as telegraph noise, looks much the same; nor where what is left of the sensor is `structured`.
    """
    cause = f"{sensor}_random_walk"
    others = [name for name in instead if name.startswith((sensor, *SHARED[sensor]))]
    told = (
        f"The biases of the {SENSORS[sensor]} change as by a random walk of {_walk(sensor, walk)}."
    )
    if others:
        names = " or ".join(in_words(name) for name in others)
        told += f" Instead it may be {names}: this campaign cannot tell them apart."
    else:
        told += " Any other change without a law would look much the same."
    yield {
        "id": f"criticism/{cause}{suffix}",
        "cause": cause,
        "sensor": sensor,
        "count": 1,
        "size": walk.size,
        "unit": UNITS[sensor],
        "severity": 1,
        "sentence": told,
        "consequence": "The sigmas of all parameters allow for it.",
        "action": "Record the positions once more, in another order, to tell a walk from others."
        if others
        else "A shorter campaign, or turns there and back, lessen what it does.",
        "verdict": ONE_OF_CLASS if others and not structured else UNKNOWN_STRUCTURE,
        "members": ", ".join([cause, *others]),
        "parameters": f"K = {walk.size:.3g} ± {walk.sigma:.2g} {UNITS[sensor]}",
    }


def walk_row(method: str, sensor: str, walk: Walk) -> Row:
    """The random walk as the extension takes it."""
    sigma = walk.sigma if np.isfinite(walk.sigma) else None
    return {"method": method, "sensor": sensor, "walk": walk.size, "sigma": sigma}


def _walk(sensor: str, walk: Walk) -> str:
    # By K per √s a bias walks by 60 K in the root of an hour.
    size, unit = (DEGREE_PER_HOUR, "°/h") if sensor == "gyro" else (MICRO_G.size, "µg")
    value, sigma = (np.array([walk.size, walk.sigma]) / size * 60).tolist()
    return f"{' ± '.join(with_sigma(value, sigma, decimals_of(sigma)))} {unit}/√h"
