"""One turn that does not stop where it should."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.profiles import Profile, Trapezoid
from laboratory.units import ARCSECOND


@dataclass
class TurnAngleError(Effect):
    """The turn of this id goes further by an angle, rad, whichever way it goes.

    The next manoeuvre starts from its set position again.
    """

    turn: str
    further: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["turn"], parameters["further_arcsec"] * ARCSECOND)

    def actual_turn(self, manoeuvre: Manoeuvre, profile: Profile) -> Profile:
        if manoeuvre.name != self.turn or not isinstance(profile, Trapezoid):
            return profile
        return replace(profile, angle=profile.angle * (1 + self.further / abs(profile.angle)))
