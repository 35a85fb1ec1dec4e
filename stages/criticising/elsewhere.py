"""Effects that are not sought in means of blocks: in the noise, and in the quality of samples."""

from collections.abc import Iterator, Sequence
from typing import Any

from stages.inference.naming.named import FOUND
from stages.model.effect import Effect
from stages.notation.causes import in_words
from stages.notation.numbers import decimals_of, with_sigma
from stages.notation.units import DEGREE_PER_HOUR

Row = dict[str, Any]

WALK = "gyro_random_walk"
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
            told = f"The biases of the gyros walk by {_walk(walk)}, which the sigmas allow for."
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


def _walk(walk: Row) -> str:
    # By K per √s a bias walks by 60 K in the root of an hour.
    value, sigma = (
        float(walk[key] or 0.0) / DEGREE_PER_HOUR * 60
        for key in ("random_walk", "random_walk_sigma")
    )
    return f"{' ± '.join(with_sigma(value, sigma, decimals_of(sigma)))} °/h/√h"
