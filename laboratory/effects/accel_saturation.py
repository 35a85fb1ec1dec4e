"""Accelerometers at the end of their range."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.units import STANDARD_GRAVITY


@dataclass(frozen=True)
class AccelSaturation(Effect):
    """|f̃_i| of a sample cannot go beyond a limit; bias and noise are in it.

    limit: (3,), m/s².
    """

    limit: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["limit_g"], dtype=float) * STANDARD_GRAVITY)

    def limits(self, increments: Reading, interval: float) -> Reading:
        most = self.limit * interval
        return replace(increments, accelerometer=np.clip(increments.accelerometer, -most, most))
