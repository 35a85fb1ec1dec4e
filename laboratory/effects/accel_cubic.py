"""An accelerometer that answers to the third power of its force."""

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
class AccelCubic(Effect):
    """f̃_i += K3_i f_i³, f_i the specific force along the axis of sensor i.

    coefficient: K3, (3,), (m/s²)/(m/s²)³. Source: IEEE Std 1293-2018, model equation, K_3.
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = MICROGRAVITY / STANDARD_GRAVITY**3
        return cls(np.array(parameters["k3_micro_g_g3"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        return Reading.of_accelerometers(self.coefficient * felt * felt**2)
