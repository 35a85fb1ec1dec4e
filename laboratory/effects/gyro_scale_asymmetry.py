"""Scale factor asymmetry of a gyro."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


class GyroScaleAsymmetry(ArrayEffect):
    """ω̃_i += A_i |ω_i|, ω_i the rate along the axis of gyro i.

    value: A, (3,), 1: half of the difference of the scale factors forward and backward.
    Source: IEEE Std 528-2019, "asymmetry error".
    """

    KEY = "asymmetry_ppm"
    UNIT = PPM

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(self.value * np.abs(sensors.gyro.project(truth.rate)))
