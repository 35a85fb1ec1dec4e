"""A gyro whose scale factor is not the same forward and backward."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


class GyroScaleAsymmetry(ArrayEffect):
    """ω̃_i += A_i |ω_i|, ω_i the rate along the axis of gyro i.

    value: A, (3,), 1: half of what the scale factors forward and backward differ by.
    Source: IEEE Std 528-2019, "asymmetry error".
    """

    KEY = "asymmetry_ppm"
    UNIT = PPM

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(self.value * np.abs(sensors.gyro.feels(truth.rate)))
