"""A gyro that feels acceleration."""

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
class GyroGSensitivity(Effect):
    """ω̃ += G f, f the specific force of the case; mass unbalance, stress of the package.

    matrix: G, (3, 3), (rad/s)/(m/s²), row = gyro, column = axis of the force.
    Source: IEEE Std 528-2019, "drift rate, acceleration-sensitive".
    """

    matrix: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = DEGREE / HOUR / STANDARD_GRAVITY
        return cls(np.array(parameters["matrix_deg_h_g"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(truth.force @ self.matrix.T)
