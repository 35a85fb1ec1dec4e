"""A table whose axes are not square."""

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
    """The level middle axis of the table leans, so faces that it brings up are not level.

    The middle axis m carries the body axis `home` from the top to where the plan has it, by the
    angle φ: m = up × home. It leans upwards by δ; home itself was made level. So the case misses
    its attitude by R(m′, φ′) R(m, φ)ᵀ, m′ the leaning axis, φ′ = φ + ε sin φ. A tumble about m
    turns φ further; about another axis it does not. lean: δ, rad; quarter: ε, rad, by which a
    quarter turn about m is too large; home: unit vector, (3,), body axes.
    """

    lean: float
    quarter: float
    home: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        home = direction(parameters.get("home", "+z"))
        quarter = parameters.get("quarter_arcsec", 0.0)
        return cls(parameters["lean_arcsec"] * ARCSECOND, quarter * ARCSECOND, home)

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        step = manoeuvre.step
        turned = 0.0 if step is None else step.angle
        back = rotation_about(manoeuvre.about, np.asarray(turned))
        start = back @ manoeuvre.up
        across = np.cross(start, self.home)
        angle = atan2(float(np.linalg.norm(across)), float(self.home @ start))
        if sin(angle) < 1e-9:  # home is up or down: the axis points away from the zero mark
            across = -back @ manoeuvre.mark
        middle = across / np.linalg.norm(across)
        about = float(middle @ manoeuvre.about)
        if abs(about) > cos(DEGREE):
            angle += about * turned
        begun = set_attitude @ rotation_about(manoeuvre.about, np.asarray(-turned))
        axis = begun @ middle
        leaning = cos(self.lean) * axis + sin(self.lean) * np.array([0.0, 0.0, 1.0])
        come = np.asarray(angle + self.quarter * sin(angle))
        return rotation_about(leaning, come) @ rotation_about(axis, np.asarray(angle)).T
