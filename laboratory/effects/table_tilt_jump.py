"""Tilt of the table that sets in at once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.effects.table_tilt_ramp import leaning
from laboratory.instants import Instants
from laboratory.motion import Turning
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableTiltJump(Effect):
    """The base of the table, with all its axes, is tilted from t₀ on, in no time.

    north, east: rad, as of a tilt that is always there; at: t₀, s since the campaign's first
    sample.
    """

    north: float
    east: float
    at: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        lean = (parameters[key] * ARCSECOND for key in ("north_arcsec", "east_arcsec"))
        return cls(*lean, parameters["at_s"])

    def table_rotations(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        return leaning(self.north, self.east, (instants.time >= self.at).astype(float), 0.0)
