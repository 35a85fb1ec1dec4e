"""Gyro biases that follow the temperature."""

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
class GyroBiasTemperature(Effect):
    """ω̃ += k ΔT, ΔT from the temperature at which the biases are as the laboratory says.

    coefficient: k, (3,), (rad/s)/K.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_deg_h_k"], dtype=float) * DEGREE / HOUR)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.warmer[:, None] * self.coefficient)
