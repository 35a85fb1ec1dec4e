"""Jump of the gyro biases."""

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
class GyroBiasJump(Effect):
    """ω̃ += b from a moment on, s since the campaign's first sample, through all logs.

    size: b, (3,), rad/s.
    """

    size: Array
    moment: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = np.array(parameters["size_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(size, parameters["at_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        since = truth.motion.instants.since(self.moment)
        return Reading.of_gyros(since[:, None] * self.size)
