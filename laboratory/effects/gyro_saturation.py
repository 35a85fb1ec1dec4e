"""Gyros at the end of their range."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.units import DEGREE


@dataclass(frozen=True)
class GyroSaturation(Effect):
    """|ω̃_i| of a sample cannot go beyond a limit; bias and noise are in it.

    limit: (3,), rad/s.
    """

    limit: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["limit_deg_s"], dtype=float) * DEGREE)

    def limits(self, increments: Reading, interval: float) -> Reading:
        most = self.limit * interval
        return replace(increments, gyro=np.clip(increments.gyro, -most, most))
