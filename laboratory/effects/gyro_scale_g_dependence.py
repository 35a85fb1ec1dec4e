"""A gyro whose scale factor changes with the force along its axis."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM, STANDARD_GRAVITY


@dataclass(frozen=True)
class GyroScaleGDependence(Effect):
    """ω̃_i += k_i ω_i f_i, the rate and the specific force along axis i.

    coefficient: k, (3,), 1/(m/s²).
    """

    coefficient: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_ppm_g"], dtype=float) * PPM / STANDARD_GRAVITY)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(self.coefficient * felt * truth.force)
