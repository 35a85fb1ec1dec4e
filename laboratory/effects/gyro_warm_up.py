"""Warm-up of the gyro biases."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


@dataclass(frozen=True)
class GyroWarmUp(Effect):
    """ω̃ += b exp(−t/τ), t since the campaign's first sample, through all logs and pauses.

    start: b, (3,), rad/s; time_constant: τ, s.
    """

    start: Array
    time_constant: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        start = np.array(parameters["start_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(start, parameters["time_constant_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        decay = np.exp(-truth.time / self.time_constant)
        return Reading.of_gyros(decay[:, None] * self.start)
