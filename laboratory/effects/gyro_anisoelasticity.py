"""Anisoelastic error of the gyros: products of two components of the specific force."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY


class GyroAnisoelasticity(ArrayEffect):
    """ω̃_i += k_i f_j f_k, j and k the other two axes.

    value: k, (3,), (rad/s)/(m/s²)². Source: IEEE Std 813-1988, acceleration-squared drift.
    """

    KEY = "k_deg_h_g2"
    UNIT = DEGREE / HOUR / STANDARD_GRAVITY**2

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        others = np.roll(truth.force, -1, axis=1) * np.roll(truth.force, -2, axis=1)
        return Reading.of_gyros(self.value * others)
