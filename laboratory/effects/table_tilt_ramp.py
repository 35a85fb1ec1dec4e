"""Steady tilt of the table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import Instants
from laboratory.motion import Turning
from laboratory.units import ARCSECOND, HOUR


@dataclass(frozen=True)
class TableTiltRamp(Effect):
    """The base of the table, with all its axes, tilts steadily towards north and east.

    north, east: rad/s, drift of where the table's vertical points, from the campaign's first
    sample on: a rotation about (−north, east, 0) in the level frame, sensed by the gyros too.
    """

    north: float
    east: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        keys = ("north_arcsec_h", "east_arcsec_h")
        return cls(*(parameters[key] * ARCSECOND / HOUR for key in keys))

    def table_rotations(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        return leaning(self.north, self.east, instants.time, 1.0)


def leaning(north: float, east: float, course: Array, slope: float) -> Sequence[Turning]:
    """A lean towards north and east times a course, (n,), with its slope by time, 1/s."""
    size = float(np.hypot(north, east))
    if not size:
        return []
    return [
        Turning(
            np.array([-north, east, 0.0]) / size,
            angle=size * course,
            rate=np.full(len(course), size * slope),
            acceleration=np.zeros(len(course)),
            steady_rate=size * slope,
        )
    ]
