"""Gyro biases that drift with the third power of time."""

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
class GyroCubicDrift(Effect):
    """ω̃ += c t³, t since the campaign's first sample, through all logs and the pauses between.

    coefficient: c, (3,), rad/s⁴.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_deg_h_h3"], dtype=float) * DEGREE / HOUR**4)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.time[:, None] ** 3 * self.coefficient)
