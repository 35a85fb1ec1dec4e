"""Warm-up of the accelerometer biases."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY


@dataclass
class AccelWarmUp(Effect):
    """f̃ += b exp(−t/τ), t since the first sample after the last switch-on.

    start: b, (3,), m/s²; time_constant: τ, s. cycles: for each log in its order, whether
    the IMU was switched off and on before it, and had cooled down.
    """

    start: Array
    time_constant: float
    cycles: Sequence[bool] = ()
    _logs: int = field(default=0, init=False)
    _switched_on: float | None = field(default=0.0, init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        start = np.array(parameters["start_micro_g"], dtype=float) * MICROGRAVITY
        return cls(start, parameters["time_constant_s"], parameters.get("cycles", ()))

    def begin_log(self, generator: np.random.Generator) -> None:
        self._logs += 1
        if self._logs <= len(self.cycles) and self.cycles[self._logs - 1]:
            self._switched_on = None

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        if self._switched_on is None:
            self._switched_on = float(truth.time[0])
        decay = np.exp(-(truth.time - self._switched_on) / self.time_constant)
        return Reading.of_accelerometers(decay[:, None] * self.start)
