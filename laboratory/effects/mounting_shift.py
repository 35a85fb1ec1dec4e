"""Shift of the IMU in its fixture."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.rotation import rotation_of
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class MountingShift(Effect):
    """From a moment on, s, the case is turned: it senses Rᵀ ω and Rᵀ f.

    rotation: R, (3, 3), of the rotation vector of the case, body axes.
    """

    rotation: Array
    moment: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        vector = np.array(parameters["rotation_arcsec"], dtype=float) * ARCSECOND
        return cls(rotation_of(vector), parameters["at_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        since = truth.motion.instants.since(self.moment)[:, None]
        force, rate = (v @ self.rotation - v for v in (truth.force, truth.rate))
        return Reading(
            since * sensors.accelerometer.project(force), since * sensors.gyro.project(rate)
        )
