"""Creep of the IMU in its fixture."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class MountingCreep(Effect):
    """The case turns by φ (1 − exp(−t/τ)): it senses f − φ × f and ω − φ × ω, to first order.

    rotation: φ, (3,), rad, body axes; time_constant: τ, s, from the campaign's first sample on.
    """

    rotation: Array
    time_constant: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        vector = np.array(parameters["rotation_arcsec"], dtype=float) * ARCSECOND
        return cls(vector, parameters["time_constant_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        course = -np.expm1(-truth.time / self.time_constant)[:, None]
        force, rate = (np.cross(v, self.rotation) for v in (truth.force, truth.rate))
        return Reading(
            course * sensors.accelerometer.project(force), course * sensors.gyro.project(rate)
        )
