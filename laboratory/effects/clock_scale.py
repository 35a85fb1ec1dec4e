"""A receiver whose clock runs fast."""

from laboratory.effects.effect import ScalarEffect
from laboratory.units import PPM


class ClockScale(ScalarEffect):
    """While its clock says 1 + ε seconds, only one has passed: samples are shorter than stamped.

    value: ε, 1.
    """

    KEY = "fast_ppm"
    UNIT = PPM

    def ticks(self) -> float:
        return 1 / (1 + self.value)
