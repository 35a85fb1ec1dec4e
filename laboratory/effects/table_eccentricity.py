"""A table whose angle encoder stands off the axis."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.harmonic import Harmonic
from laboratory.instants import Instants
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Turning
from laboratory.rotation import rotation_about
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableEccentricity(Effect):
    """The true angle is θ + s sin θ + c (cos θ − 1), θ that of the scale since the start.

    error: the harmonic of order 1, rad. It closes over a whole turn.
    """

    error: Harmonic

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        sine, cosine = parameters["sin_arcsec"] * ARCSECOND, parameters["cos_arcsec"] * ARCSECOND
        return cls(Harmonic(1.0, cosine, sine))

    def moves(self, turnings: Sequence[Turning], instants: Instants) -> Sequence[Turning]:
        if not turnings or not turnings[0].planned:
            return turnings
        return [self.error.added_to(turnings[0]), *turnings[1:]]

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        angle = 0.0 if manoeuvre.step is None else manoeuvre.step.angle
        further = self.error.value(np.asarray(angle))
        return rotation_about(set_attitude @ manoeuvre.about, further)
