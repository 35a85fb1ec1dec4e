"""Biases that are others after each switch-on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, MICROGRAVITY


@dataclass
class TurnOnBias(Effect):
    """In each log other biases are added: normal, independent by axis and log.

    gyro: their standard deviation, rad/s; accelerometer: m/s². cycles: for each log in its order,
    whether the IMU was switched off and on before it, so that its biases are others; None: always.
    """

    gyro: float
    accelerometer: float
    cycles: Sequence[bool] | None = None
    _logs: int = field(default=0, init=False)
    _biases: Array = field(default_factory=lambda: np.zeros(6), init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters.get("gyro_deg_h", 0.0) * DEGREE / HOUR,
            parameters.get("accelerometer_micro_g", 0.0) * MICROGRAVITY,
            parameters.get("cycles"),
        )

    def begin_log(self, generator: np.random.Generator) -> None:
        self._logs += 1
        if self._logs > 1 and self.cycles is not None and not self.cycles[self._logs - 1]:
            return
        scale = np.repeat([self.accelerometer, self.gyro], 3)
        self._biases = scale * generator.standard_normal(6)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        ones = np.ones((len(truth.time), 1))
        return Reading(ones * self._biases[:3], ones * self._biases[3:])
