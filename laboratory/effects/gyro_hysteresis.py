"""Gyro biases that depend on the way of the last turn."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.memory import last_sign
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR

LEAST = DEGREE  # rad/s: what counts as a turn


@dataclass
class GyroHysteresis(Effect):
    """ω̃_i += h_i s_i, s_i the sign of the rate when gyro i last turned, 0 before it ever has.

    offset: h, (3,), rad/s.
    """

    offset: Array
    _sign: Array = field(default_factory=lambda: np.zeros(3), init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["offset_deg_h"], dtype=float) * DEGREE / HOUR)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        signs = last_sign(sensors.gyro.feels(truth.rate), LEAST, self._sign)
        self._sign = signs[-1]
        return Reading.of_gyros(signs * self.offset)
