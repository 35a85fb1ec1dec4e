"""A gyro whose scale factor changes evenly with the rate."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, PPM


@dataclass(frozen=True)
class GyroScaleQuadratic(Effect):
    """ω̃_i += K2_i ω_i |ω_i|, ω_i the rate along the axis of gyro i.

    coefficient: K2, (3,), 1/(rad/s).
    Source: IEEE Std 528-2019, "nonlinearity".
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k2_ppm_per_deg_s"], dtype=float) * PPM / DEGREE)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(self.coefficient * felt * np.abs(felt))
