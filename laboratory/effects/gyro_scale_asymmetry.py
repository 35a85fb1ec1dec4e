"""A gyro whose scale factor is not the same forward and backward."""

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
class GyroScaleAsymmetry(Effect):
    """ω̃_i += A_i |ω_i|, ω_i the rate along the axis of gyro i.

    asymmetry: A, (3,), 1: half of what the scale factors forward and backward differ by.
    Source: IEEE Std 528-2019, "asymmetry error".
    """

    asymmetry: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["asymmetry_ppm"], dtype=float) * PPM)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(self.asymmetry * np.abs(sensors.gyro.feels(truth.rate)))
