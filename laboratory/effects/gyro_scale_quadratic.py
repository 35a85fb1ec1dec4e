"""Quadratic nonlinearity of a gyro, odd in the rate."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, PPM


class GyroScaleQuadratic(ArrayEffect):
    """ω̃_i += K2_i ω_i |ω_i|, ω_i the rate along the axis of gyro i.

    value: K2, (3,), 1/(rad/s).
    Source: IEEE Std 528-2019, "nonlinearity".
    """

    KEY = "k2_ppm_per_deg_s"
    UNIT = PPM / DEGREE

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(self.value * rate * np.abs(rate))
