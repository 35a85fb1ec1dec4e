"""Tilt of the table."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.rotation import rotation_of
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableTilt(Effect):
    """The base of the table, with all its axes, is tilted towards north and east.

    north, east: rad, where the table's vertical points: (east, north, 1) in the level frame, to
    first order. The rotation vector is (−north, east, 0).
    """

    north: float
    east: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["north_arcsec"] * ARCSECOND, parameters["east_arcsec"] * ARCSECOND)

    def table_tilt(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        return rotation_of(np.array([-self.north, self.east, 0.0]))
