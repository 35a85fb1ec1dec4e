"""A receiver whose clock runs fast."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.units import PPM


@dataclass(frozen=True)
class ClockScale(Effect):
    """While its clock says 1 + ε seconds, only one has passed: samples are shorter than stamped.

    fast: ε, 1.
    """

    fast: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["fast_ppm"] * PPM)

    def ticks(self) -> float:
        return 1 / (1 + self.fast)
