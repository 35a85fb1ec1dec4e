"""Rate error of the table."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.profiles import Profile, Steady, Trapezoid
from laboratory.units import PPM


@dataclass(frozen=True)
class TableSpeedError(Effect):
    """Relative errors of rate and acceleration; the angle of a whole turn stays exact.

    rate: 1, of the steady rate; ramp: 1, of the acceleration.
    """

    rate: float
    ramp: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["rate_ppm"] * PPM, parameters.get("ramp_ppm", 0.0) * PPM)

    def actual_profile(self, profile: Profile) -> Profile:
        if isinstance(profile, Steady):
            return replace(profile, rate=profile.rate * (1 + self.rate))
        if isinstance(profile, Trapezoid):
            return replace(
                profile,
                set_rate=profile.set_rate * (1 + self.rate),
                set_acceleration=profile.set_acceleration * (1 + self.ramp),
            )
        return profile
