"""The measurement equation of three sensors as text, which C and Python evaluate alike.

reading_x = M_xx * w_x + M_xy * w_y + M_xz * w_z + bias_x + <effect>.<parameter> * f_x + …
"""

import re

from inertial.campaign.measurement import EffectOfResult
from inertial.tables import AXES
from inertial.text.parameters import SENSOR_OF

TRUTH = {"accelerometer": "f", "gyroscope": "w"}  # what the three sensors feel


def added_by(effect: EffectOfResult, kind: str) -> dict[str, str]:
    """What an effect adds to the reading of each axis, by axis."""
    sensor = SENSOR_OF[kind]
    sums: dict[str, list[str]] = {}
    for term in effect.effect.terms:
        of, _unused, axis = term.channel.partition("_")
        if of == sensor and term.parameter in effect.parameters:
            factor = _qualified(term.factor, effect)
            sums.setdefault(axis, []).append(f"{effect.effect.name}.{term.parameter} * {factor}")
    return {axis: " + ".join(terms) for axis, terms in sums.items()}


def _qualified(factor: str, effect: EffectOfResult) -> str:
    """The factor with each constant under the name that it has in the file."""
    for name in effect.constants:
        factor = re.sub(rf"\b{name}\b", f"{effect.effect.name}.{name}", factor)
    return factor


def equations(kind: str, effects: list[EffectOfResult]) -> dict[str, str]:
    """The reading of each axis as a function of what is sensed, time and temperature."""
    truth = TRUTH[kind]
    added = [added_by(effect, kind) for effect in effects]
    return {
        axis: " + ".join(
            [
                *(f"M_{axis}{other} * {truth}_{other}" for other in AXES),
                f"bias_{axis}",
                *(terms[axis] for terms in added if axis in terms),
            ]
        )
        for axis in AXES
    }
