"""One position of a table of several axes that is set off."""

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
class TableAxisError(Effect):
    """In one position the table leans, with the axis about which it turns there.

    north, east: rad, where its vertical points: (east, north, 1) in the level frame, to first
    order. The rotation vector is (−north, east, 0).
    """

    position: str
    north: float
    east: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        north, east = (parameters[f"{name}_arcsec"] * ARCSECOND for name in ("north", "east"))
        return cls(parameters["position"], north, east)

    def table_tilt(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        if manoeuvre.position != self.position:
            return np.eye(3)
        return rotation_of(np.array([-self.north, self.east, 0.0]))
