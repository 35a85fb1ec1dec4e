"""A drift of the gyro biases that begins during the campaign."""

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
class GyroLateDrift(Effect):
    """ω̃ += c max(t − t₀, 0), t since the campaign's first sample.

    ramp: c, (3,), rad/s²; first: t₀, s.
    """

    ramp: Array
    first: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        ramp = np.array(parameters["ramp_deg_h_h"], dtype=float) * DEGREE / HOUR**2
        return cls(ramp, parameters["from_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(np.maximum(truth.time - self.first, 0.0)[:, None] * self.ramp)
