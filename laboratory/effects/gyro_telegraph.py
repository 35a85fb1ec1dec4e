"""Telegraph noise of the gyro biases: random jumps between two levels."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


@dataclass
class GyroTelegraph(Effect):
    """The bias is +b or −b, and changes its sign at random: popcorn noise, a loose contact.

    height: b, (3,), rad/s; dwell: mean time between two changes, s, exponentially distributed.
    It continues in the pauses. The integral over a sample is exact.
    """

    height: Array
    dwell: float
    _sign: float = field(default=1.0, init=False)
    _next: float = field(default=0.0, init=False)  # s: when the sign changes next

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        height = np.array(parameters["height_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(height, parameters["dwell_s"])

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading:
        instants = truth.motion.instants
        edges = instants.start + np.arange(instants.samples + 1) * instants.interval
        changes, signs = [edges[0]], [self._sign]
        while self._next < edges[-1]:
            self._sign = -self._sign
            if self._next > edges[0]:
                changes.append(self._next)
                signs.append(self._sign)
            else:
                signs[0] = self._sign
            self._next += generator.exponential(self.dwell)
        path = np.concatenate([[0.0], np.cumsum(np.diff([*changes, edges[-1]]) * signs)])
        within = np.diff(np.interp(edges, [*changes, edges[-1]], path))
        return Reading.of_gyros(within[:, None] * self.height)
