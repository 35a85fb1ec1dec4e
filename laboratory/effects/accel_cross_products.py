"""An accelerometer that answers to products of forces."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


@dataclass(frozen=True)
class AccelCrossProducts(Effect):
    """f̃_i += K_i,yz f_y f_z + K_i,zx f_z f_x + K_i,xy f_x f_y, forces along the case's axes.

    matrix: K, (3, 3), (m/s²)/(m/s²)², row = accelerometer, columns yz, zx, xy.
    Source: IEEE Std 1293-2018, model equation, cross-coupling coefficients.
    """

    matrix: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = MICROGRAVITY / STANDARD_GRAVITY**2
        return cls(np.array(parameters["matrix_micro_g_g2"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        x, y, z = truth.force.T
        return Reading.of_accelerometers(np.column_stack([y * z, z * x, x * y]) @ self.matrix.T)
