"""Rate error of the receiver clock."""

from laboratory.effects.effect import ScalarEffect
from laboratory.units import PPM


class ClockScale(ScalarEffect):
    """The receiver clock advances by 1 + ε s per second: samples are shorter than their stamps say.

    value: ε, 1.
    """

    KEY = "fast_ppm"
    UNIT = PPM

    def clock_ratio(self) -> float:
        return 1 / (1 + self.value)
