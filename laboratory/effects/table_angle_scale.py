"""A table whose degrees are too large."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.profiles import Profile, Steady, Trapezoid
from laboratory.rotation import rotation_about
from laboratory.units import PPM


@dataclass(frozen=True)
class TableAngleScale(Effect):
    """An angle of 360° on its scale is 360° (1 + ε): of turns, and of the steps of a tumble.

    scale: ε, 1. The next manoeuvre starts from its set position again.
    """

    scale: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["scale_ppm"] * PPM)

    def sets(self, profile: Profile) -> Profile:
        if isinstance(profile, Steady):
            return replace(profile, rate=profile.rate * (1 + self.scale))
        if isinstance(profile, Trapezoid):
            return replace(profile, angle=profile.angle * (1 + self.scale))
        return profile

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        further = 0.0 if manoeuvre.step is None else self.scale * manoeuvre.step.angle
        return rotation_about(set_attitude @ manoeuvre.about, np.asarray(further))
