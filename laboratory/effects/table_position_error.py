"""Position error and backlash of the table."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.manoeuvre import Manoeuvre
from laboratory.rotation import rotation_about, rotation_of
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TablePositionError(Effect):
    """Every position has a random tilt, and a tumble has backlash.

    sigma: rad, standard deviation of two tilts, about east and about north, in addition to those
    that the campaign states; backlash: rad, difference between the rests of a tumble approached
    from one side and from the other, half of it each, always short of the set angle.
    """

    sigma: float
    backlash: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        backlash = parameters.get("backlash_arcsec", 0.0)
        return cls(parameters["sigma_arcsec"] * ARCSECOND, backlash * ARCSECOND)

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        stream = chance.stream("table_position_error", manoeuvre.shares)
        east, north = stream.normal(0.0, self.sigma, 2)
        offset = 0.0 if manoeuvre.step is None else -manoeuvre.step.way * self.backlash / 2
        backlash = rotation_about(set_attitude @ manoeuvre.about, np.asarray(offset))
        return rotation_of(np.array([east, north, 0.0])) @ backlash
