"""A table that turns unevenly, from tooth to tooth of its gear."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin
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
from laboratory.units import ARCSECOND, DEGREE


@dataclass(frozen=True)
class TableRipple(Effect):
    """The true angle is θ + A (sin(nθ + φ) − sin φ), θ that of the scale since the start.

    error: the harmonic of order n, rad; any n above 0, whole or not. Where a turn does not close,
    the next manoeuvre starts from its set position all the same.
    """

    error: Harmonic

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        size = parameters["amplitude_arcsec"] * ARCSECOND
        phase = parameters.get("phase_deg", 0.0) * DEGREE
        return cls(Harmonic(parameters["order"], size * sin(phase), size * cos(phase)))

    def moves(self, turnings: Sequence[Turning], instants: Instants) -> Sequence[Turning]:
        if not turnings or not turnings[0].planned:
            return turnings
        return [self.error.added_to(turnings[0]), *turnings[1:]]

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        angle = 0.0 if manoeuvre.step is None else manoeuvre.step.angle
        further = self.error.value(np.asarray(angle))
        return rotation_about(set_attitude @ manoeuvre.about, further)
