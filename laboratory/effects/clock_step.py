"""Step of the receiver clock."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from laboratory.arrays import Counts
from laboratory.effects.effect import Effect
from laboratory.gps_time import NANOSECONDS
from laboratory.units import MILLISECOND


@dataclass(frozen=True)
class ClockStep(Effect):
    """After a moment all stamps are later by a step, and no sample is missing.

    moment, step: ns, the moment since the campaign's first sample.
    """

    moment: int
    step: int

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        moment = round(parameters["at_s"] * NANOSECONDS)
        return cls(moment, round(parameters["step_ms"] * MILLISECOND * NANOSECONDS))

    def stamps(self, stamps: Counts) -> Counts:
        return stamps + self.step * (stamps >= self.moment)
