"""Gyros that lag behind."""

from laboratory.effects.effect import ScalarEffect
from laboratory.units import MILLISECOND


class GyroLatency(ScalarEffect):
    """ω̃(t) tells what was at t − τ; table and accelerometers are on time.

    value: τ, s. It is exact in manoeuvres and steps; a change of position within T leaves the last
    10 (τ/T)³ of its angle behind, 2e-9 for 5 ms of 8 s.
    """

    KEY = "lag_ms"
    UNIT = MILLISECOND

    def delays(self) -> float:
        return self.value
