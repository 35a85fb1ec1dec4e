"""Latency of the gyros."""

from laboratory.effects.effect import ScalarEffect
from laboratory.units import MILLISECOND


class GyroLatency(ScalarEffect):
    """ω̃(t) is the rate at t − τ; table and accelerometers have no delay.

    value: τ, s. It is exact in manoeuvres and steps; a change of position within T lacks the last
    10 (τ/T)³ of its angle, 2e-9 for 5 ms of 8 s.
    """

    KEY = "lag_ms"
    UNIT = MILLISECOND

    def gyro_delay(self) -> float:
        return self.value
