"""A table whose axis wobbles as it turns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.harmonic import LEVEL, Harmonic, across
from laboratory.instants import Instants
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Turning
from laboratory.rotation import rotation_about
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableWobble(Effect):
    """The axis leans, and its lean goes round n times while the table turns once.

    east, north: rad, where the upper end of the axis points at the start of a turn or tumble, and
    at every other position; order: n, 2 where the bearing is oval, below 0 against the table's own
    sense. In the mean of a turn the axis is upright. Of one that is not, east and north are what
    they become when up is turned into it on the shortest way.
    """

    east: float
    north: float
    order: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["east_arcsec"] * ARCSECOND,
            parameters["north_arcsec"] * ARCSECOND,
            parameters.get("order", 2.0),
        )

    def towards(self, axis: Array) -> tuple[Harmonic, Harmonic]:
        """The lean towards east and towards north, beyond that at the start; axis: (3,), level."""
        order = self.order if axis[2] >= -LEVEL else -self.order
        return (
            Harmonic(order, cosine=self.east, sine=-self.north),
            Harmonic(order, cosine=self.north, sine=self.east),
        )

    def carries(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        if not turnings or not turnings[0].planned:
            return []
        axis = attitude @ turnings[0].axis
        (east, north), (to_east, to_north) = across(axis), self.towards(axis)
        return [to_north.turning(-east, turnings[0]), to_east.turning(north, turnings[0])]

    def tilts(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        axis = set_attitude @ manoeuvre.about
        (east, north), (to_east, to_north) = across(axis), self.towards(axis)
        angle = np.asarray(0.0 if manoeuvre.step is None else manoeuvre.step.angle)
        to_north_now, to_east_now = (
            self.north + to_north.value(angle),
            self.east + to_east.value(angle),
        )
        return rotation_about(-east, to_north_now) @ rotation_about(north, to_east_now)
