"""Scale error of the table angle."""

from dataclasses import replace

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.effects.effect import ScalarEffect
from laboratory.manoeuvre import Manoeuvre
from laboratory.profiles import Profile, Steady, Trapezoid
from laboratory.rotation import rotation_about
from laboratory.units import PPM


class TableAngleScale(ScalarEffect):
    """An angle of 360° on its scale is 360° (1 + ε): of turns, and of the steps of a tumble.

    So is all that is set by this scale, rate and acceleration, and a turn takes its time. value: ε,
    1. The next manoeuvre starts from its set position again.
    """

    KEY = "scale_ppm"
    UNIT = PPM

    def actual_profile(self, profile: Profile) -> Profile:
        if isinstance(profile, Steady):
            return replace(profile, rate=profile.rate * (1 + self.value))
        if isinstance(profile, Trapezoid):
            return replace(
                profile,
                angle=profile.angle * (1 + self.value),
                set_rate=profile.set_rate * (1 + self.value),
                set_acceleration=profile.set_acceleration * (1 + self.value),
            )
        return profile

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        further = 0.0 if manoeuvre.step is None else self.value * manoeuvre.step.angle
        return rotation_about(set_attitude @ manoeuvre.about, np.asarray(further))
