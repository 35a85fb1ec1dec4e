"""An accelerometer that answers to the square of its force."""

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
class AccelQuadratic(Effect):
    """f̃_i += K2_i f_i², f_i the specific force along the axis of sensor i.

    coefficient: K2, (3,), (m/s²)/(m/s²)². Source: IEEE Std 1293-2018, model equation, K_2.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = MICROGRAVITY / STANDARD_GRAVITY**2
        return cls(np.array(parameters["k2_micro_g_g2"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(
            self.coefficient * sensors.accelerometer.feels(truth.force) ** 2
        )
