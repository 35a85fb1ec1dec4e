"""A gyro whose scale factor changes evenly with the rate."""

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

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(self.value * felt * np.abs(felt))
