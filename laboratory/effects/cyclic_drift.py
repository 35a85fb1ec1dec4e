"""Biases that follow a regulated temperature, such as that of a laboratory's air conditioning."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, MICROGRAVITY


@dataclass(frozen=True)
class CyclicDrift(Effect):
    """ω̃ += a sin(2π t/P + φ), and so the accelerometers, t since the campaign's first sample.

    gyro, accelerometer: a, (3,), rad/s and m/s²; period: P, s; phase: φ, rad.
    """

    gyro: Array
    accelerometer: Array
    period: float
    phase: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        gyro = np.array(parameters.get("gyro_deg_h", [0, 0, 0]), float) * DEGREE / HOUR
        forces = np.array(parameters.get("accelerometer_micro_g", [0, 0, 0]), float)
        phase = np.radians(parameters["phase_deg"])
        return cls(gyro, forces * MICROGRAVITY, parameters["period_s"], float(phase))

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        wave = np.sin(2 * np.pi * truth.time / self.period + self.phase)[:, None]
        return Reading(wave * self.accelerometer, wave * self.gyro)
