"""A table that misses its positions."""

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
    """Every position is tilted by chance, and a tumble has backlash.

    sigma: rad, standard deviation of two tilts, about east and about north, beside those that the
    campaign states; backlash: rad, by which the rests of a tumble differ that are come to from one
    side and from the other, half of it each, always short of the set angle.
    """

    sigma: float
    backlash: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        backlash = parameters.get("backlash_arcsec", 0.0)
        return cls(parameters["sigma_arcsec"] * ARCSECOND, backlash * ARCSECOND)

    def misses(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        stream = chance.stream("table_position_error", manoeuvre.shares)
        east, north = stream.normal(0.0, self.sigma, 2)
        short = 0.0 if manoeuvre.step is None else -manoeuvre.step.way * self.backlash / 2
        lost = rotation_about(set_attitude @ manoeuvre.about, np.asarray(short))
        return rotation_of(np.array([east, north, 0.0])) @ lost
