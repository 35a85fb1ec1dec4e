"""Accelerometer scale factors that follow the temperature."""

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
class AccelScaleTemperature(Effect):
    """f̃_i += k_i ΔT f_i, f_i the specific force along the axis of accelerometer i.

    coefficient: k, (3,), 1/K.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_ppm_k"], dtype=float) * PPM)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        return Reading.of_accelerometers(truth.warmer[:, None] * self.coefficient * felt)
