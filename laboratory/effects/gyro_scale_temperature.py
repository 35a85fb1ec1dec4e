"""Gyro scale factors that follow the temperature."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


@dataclass(frozen=True)
class GyroScaleTemperature(Effect):
    """ω̃_i += k_i ΔT ω_i, ω_i the rate along the axis of gyro i.

    coefficient: k, (3,), 1/K.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_ppm_k"], dtype=float) * PPM)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(truth.warmer[:, None] * self.coefficient * felt)
