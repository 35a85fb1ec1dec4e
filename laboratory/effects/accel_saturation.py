"""Saturation of the accelerometers."""

from dataclasses import replace

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading
from laboratory.units import STANDARD_GRAVITY


class AccelSaturation(ArrayEffect):
    """|f̃_i| of a sample, bias and noise included, cannot exceed a limit.

    value: (3,), m/s².
    """

    KEY = "limit_g"
    UNIT = STANDARD_GRAVITY

    def recorded_increments(self, increments: Reading, interval: float) -> Reading:
        most = self.value * interval
        return replace(increments, accelerometer=np.clip(increments.accelerometer, -most, most))
