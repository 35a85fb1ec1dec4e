"""A bias of the gyros that is another one for a while."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


@dataclass(frozen=True)
class GyroDisturbance(Effect):
    """ω̃ += b from one moment to another: a load on the same supply, a magnet nearby.

    size: b, (3,), rad/s; first, last: s since the campaign's first sample.
    """

    size: Array
    first: float
    last: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = np.array(parameters["size_deg_h"], dtype=float) * DEGREE / HOUR
        return cls(size, parameters["from_s"], parameters["to_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        instants = truth.motion.instants
        during = instants.since(self.first) - instants.since(self.last)
        return Reading.of_gyros(during[:, None] * self.size)
