"""A gyro bias that drifts evenly."""

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
class GyroBiasRamp(Effect):
    """ω̃ += c t, t since the campaign's first sample, through all logs and the pauses between.

    ramp: c, (3,), rad/s².
    """

    ramp: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["ramp_deg_h_h"], dtype=float) * DEGREE / HOUR**2)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.time[:, None] * self.ramp)
