"""A bias of the gyros that grows with a power of the rate."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


@dataclass(frozen=True)
class GyroRatePower(Effect):
    """ω̃_i += k_i |ω_i|^p, alike for both senses.

    size: k ω₁^p, (3,), rad/s, with ω₁ = 10 °/s; power: p.
    """

    size: Array
    power: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = np.array(parameters["at_10_deg_s_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(size, parameters["power"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = np.abs(sensors.gyro.project(truth.rate)) / (10 * DEGREE)
        return Reading.of_gyros(self.size * rate**self.power)
