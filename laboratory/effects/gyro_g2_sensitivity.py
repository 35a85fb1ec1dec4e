"""A gyro that feels the square of acceleration."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY


@dataclass(frozen=True)
class GyroG2Sensitivity(Effect):
    """ω̃_i += G2_i f_i², f_i the specific force along the case's axis i; unequal stiffness.

    coefficient: G2, (3,), (rad/s)/(m/s²)².
    Source: IEEE Std 528-2019, "drift rate, acceleration-squared-sensitive".
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = DEGREE / HOUR / STANDARD_GRAVITY**2
        return cls(np.array(parameters["k_deg_h_g2"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(self.coefficient * truth.force**2)
