"""Hysteresis of the gyros: a bias that depends on the direction of the last turn."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import last_sign
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR

MIN_TURN_RATE = DEGREE  # rad/s


@dataclass
class GyroHysteresis(ArrayEffect):
    """ω̃_i += h_i s_i, s_i the sign of the rate when gyro i last turned, 0 before it ever has.

    value: h, (3,), rad/s.
    """

    KEY = "offset_deg_h"
    UNIT = DEGREE / HOUR

    _sign: Array = field(default_factory=lambda: np.zeros(3), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        signs = last_sign(sensors.gyro.project(truth.rate), MIN_TURN_RATE, self._sign)
        self._sign = signs[-1]
        return Reading.of_gyros(signs * self.value)
