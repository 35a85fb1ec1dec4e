"""Gyros that lag behind."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.units import MILLISECOND


@dataclass(frozen=True)
class GyroLatency(Effect):
    """ω̃(t) tells what was at t − τ; table and accelerometers are on time.

    lag: τ, s. It is exact in manoeuvres and steps; a change of position within T leaves the last
    10 (τ/T)³ of its angle behind, 2e-9 for 5 ms of 8 s.
    """

    lag: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["lag_ms"] * MILLISECOND)

    def delays(self) -> float:
        return self.lag
