"""An accelerometer whose scale factor is not the same up and down."""

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
class AccelScaleAsymmetry(Effect):
    """f̃_i += A_i |f_i|, f_i the specific force along the axis of sensor i.

    asymmetry: A, (3,), 1. Source: IEEE Std 1293-2018, model equation, scale factor asymmetry.
    """

    asymmetry: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = MICROGRAVITY / STANDARD_GRAVITY
        return cls(np.array(parameters["asymmetry_micro_g_g"], dtype=float) * unit)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        return Reading.of_accelerometers(self.asymmetry * np.abs(felt))
