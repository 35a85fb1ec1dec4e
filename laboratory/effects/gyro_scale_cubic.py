"""A gyro whose scale factor changes with the square of the rate."""

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
class GyroScaleCubic(Effect):
    """ω̃_i += K3_i ω_i³, ω_i the rate along the axis of gyro i.

    coefficient: K3, (3,), 1/(rad/s)².
    Source: IEEE Std 528-2019, "nonlinearity".
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = PPM / DEGREE**2
        return cls(np.array(parameters["k3_ppm_per_deg_s_2"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(self.coefficient * felt * felt**2)
