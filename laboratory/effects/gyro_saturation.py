"""Gyros at the end of their range."""

from dataclasses import replace

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading
from laboratory.units import DEGREE


class GyroSaturation(ArrayEffect):
    """|ω̃_i| of a sample cannot go beyond a limit; bias and noise are in it.

    value: (3,), rad/s.
    """

    KEY = "limit_deg_s"
    UNIT = DEGREE

    def limits(self, increments: Reading, interval: float) -> Reading:
        most = self.value * interval
        return replace(increments, gyro=np.clip(increments.gyro, -most, most))
