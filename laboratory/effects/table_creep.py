"""Slow rotation of the table while it should be at rest."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import Instants
from laboratory.motion import Turning
from laboratory.units import DEGREE, HOUR


@dataclass(frozen=True)
class TableCreep(Effect):
    """The whole table turns about a horizontal or the vertical axis, and keeps the angle reached.

    The angle is r (t − t₀) from t₀ = `start` to `end`, s since the campaign's first sample, and
    constant before and after: through all logs, turns and pauses. axis: unit vector, (3,), level
    frame; rate: r, rad/s, right-hand rule. It is a motion like any other, sensed by gyros and
    accelerometers.
    """

    axis: Array
    rate: float
    start: float
    end: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            np.eye(3)[["east", "north", "up"].index(parameters["about"])],
            parameters["rate_deg_h"] * DEGREE / HOUR,
            parameters["from_s"],
            parameters["to_s"],
        )

    def table_rotations(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        if self.rate == 0 or instants.time[-1] <= self.start:
            return []
        since = np.clip(instants.time, self.start, self.end) - self.start
        turning = (instants.time >= self.start) & (instants.time < self.end)
        return [
            Turning(
                self.axis,
                angle=self.rate * since,
                rate=self.rate * turning.astype(float),
                acceleration=np.zeros_like(since),
                steady_rate=abs(self.rate),
            )
        ]
