"""Non-orthogonality of the axes of the table."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2, cos, sin
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.axes import direction
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.rotation import rotation_about
from laboratory.units import ARCSECOND, DEGREE


@dataclass(frozen=True)
class TableAxisNonOrthogonality(Effect):
    """The horizontal middle axis of the table is inclined, so faces that it turns up are not level.

    The middle axis m turns the body axis `home` from the top to its direction in the plan, by the
    angle φ: m = up × home. It is inclined upwards by δ; the table was levelled with home up. So
    the error of the attitude is R(m′, φ′) R(m, φ)ᵀ, m′ the inclined axis, φ′ = φ + ε sin φ. A
    tumble about m changes φ; about another axis it does not. inclination: δ, rad; quarter: ε, rad,
    by which a quarter turn about m is too large; home: unit vector, (3,), body axes.
    """

    inclination: float
    quarter: float
    home: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        home = direction(parameters.get("home", "+z"))
        quarter = parameters.get("quarter_arcsec", 0.0)
        return cls(parameters["lean_arcsec"] * ARCSECOND, quarter * ARCSECOND, home)

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        axis, angle = middle_axis(manoeuvre, set_attitude, self.home)
        inclined = cos(self.inclination) * axis + sin(self.inclination) * np.array([0.0, 0.0, 1.0])
        true_angle = np.asarray(angle + self.quarter * sin(angle))
        return rotation_about(inclined, true_angle) @ rotation_about(axis, np.asarray(angle)).T


def middle_axis(manoeuvre: Manoeuvre, set_attitude: Array, home: Array) -> tuple[Array, float]:
    """The middle axis of the table, (3,), level frame, and its angle, rad: 0 where home is up.

    Where home is up or down it points away from the zero mark.
    """
    step = manoeuvre.step
    turned = 0.0 if step is None else step.angle
    back = rotation_about(manoeuvre.about, np.asarray(turned))
    start = back @ manoeuvre.up
    across = np.cross(start, home)
    angle = atan2(float(np.linalg.norm(across)), float(home @ start))
    if sin(angle) < 1e-9:
        across = -back @ manoeuvre.mark
    middle = across / np.linalg.norm(across)
    about = float(middle @ manoeuvre.about)
    if abs(about) > cos(DEGREE):
        angle += about * turned
    at_start = set_attitude @ rotation_about(manoeuvre.about, np.asarray(-turned))
    return at_start @ middle, angle
