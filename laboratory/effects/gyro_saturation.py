"""Saturation of the gyros."""

from dataclasses import replace

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading
from laboratory.units import DEGREE


class GyroSaturation(ArrayEffect):
    """|ω̃_i| of a sample, bias and noise included, cannot exceed a limit.

    value: (3,), rad/s.
    """

    KEY = "limit_deg_s"
    UNIT = DEGREE

    def recorded_increments(self, increments: Reading, interval: float) -> Reading:
        most = self.value * interval
        return replace(increments, gyro=np.clip(increments.gyro, -most, most))
