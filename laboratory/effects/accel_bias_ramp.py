"""An accelerometer bias that drifts evenly."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import HOUR


@dataclass(frozen=True)
class AccelBiasRamp(Effect):
    """f̃ += c t, t since the campaign's first sample, through all logs and the pauses between.

    ramp: c, (3,), m/s³.
    """

    ramp: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["ramp_m_s2_h"], dtype=float) / HOUR)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_accelerometers(truth.time[:, None] * self.ramp)
