"""Play between the drive of the table and its platform."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import copysign
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.profiles import Profile, Trapezoid
from laboratory.units import ARCSECOND


@dataclass
class TableBacklash(Effect):
    """The drive crosses its play, rad, before the platform follows it the other way.

    `side`: of the play on which it rests, none before the first turn. Only turns move the drive;
    the next manoeuvre starts from its set position again.
    """

    play: float
    side: float | None = field(default=None, init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["play_arcsec"] * ARCSECOND)

    def actual_turn(self, manoeuvre: Manoeuvre, profile: Profile) -> Profile:
        if not isinstance(profile, Trapezoid) or profile.angle == 0:
            return profile
        below = manoeuvre.about @ manoeuvre.up < -1e-2
        before, self.side = self.side, copysign(1.0, -profile.angle if below else profile.angle)
        if before in (None, self.side):
            return profile
        return replace(profile, angle=profile.angle - copysign(self.play, profile.angle))
