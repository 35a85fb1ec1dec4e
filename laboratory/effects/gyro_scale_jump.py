"""Jump of the scale factors of the gyros."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import PPM


@dataclass(frozen=True)
class GyroScaleJump(Effect):
    """ω̃_i += k_i ω_i from a moment on, s since the campaign's first sample, through all logs.

    size: k, (3,).
    """

    size: Array
    moment: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["k_ppm"], dtype=float) * PPM, parameters["at_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        since = truth.motion.instants.since(self.moment)
        sensed = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(since[:, None] * sensed * self.size)
