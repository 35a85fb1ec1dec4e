"""A gyro that does not answer to small rates."""

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
class GyroDeadBand(Effect):
    """The rate that gyro i feels counts for nothing while |ω_i| is below a width: lock-in.

    It acts on the rate along the gyro's axis, M ω; bias and noise are added afterwards.
    width: (3,), rad/s. Source: IEEE Std 528-2019, "dead band".
    """

    width: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["width_deg_h"], dtype=float) * DEGREE / HOUR)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.gyro.feels(truth.rate)
        return Reading.of_gyros(np.where(np.abs(felt) < self.width, -felt, 0.0))
