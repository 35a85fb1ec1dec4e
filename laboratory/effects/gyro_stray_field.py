"""Gyros disturbed by the stray field of the table's motor."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import Instants
from laboratory.motion import Turning
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


@dataclass
class GyroStrayField(Effect):
    """ω̃ += a sin(n θ + φ) while the table turns, θ its angle since the start of the turn.

    The motor, whose current flows as it turns, turns n times as fast as the table: by a friction
    drive or a belt, so n is no integer.
    size: a, (3,), rad/s; order: n; phase: φ, rad.
    """

    size: Array
    order: float
    phase: float
    _table: Turning | None = field(default=None, init=False)  # of this segment

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = np.array(parameters["size_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(size, parameters["order"], float(np.radians(parameters["phase_deg"])))

    def change_rotations(
        self, turnings: Sequence[Turning], instants: Instants
    ) -> Sequence[Turning]:
        self._table = turnings[0] if turnings and turnings[0].planned else None
        return turnings

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading | None:
        if self._table is None:
            return None
        wave = np.sin(self.order * self._table.angle + self.phase) * (self._table.rate != 0)
        return Reading.of_gyros(wave[:, None] * self.size)
