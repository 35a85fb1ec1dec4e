"""Latency of the accelerometers."""

from laboratory.effects.effect import ScalarEffect
from laboratory.units import MILLISECOND


class AccelLatency(ScalarEffect):
    """f̃(t) is the specific force at t − τ; table and gyros have no delay.

    value: τ, s.
    """

    KEY = "lag_ms"
    UNIT = MILLISECOND

    def accelerometer_delay(self) -> float:
        return self.value
