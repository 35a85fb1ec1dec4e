"""Wobble of the table axis."""

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
    """The axis is tilted, and the direction of the tilt rotates n times per revolution.

    east, north: rad, tilt of the upper end of the axis at the start of a turn or tumble, and
    at every other position; order: n, 2 for an oval bearing, negative against the sense of the
    table. The mean of the tilt over a turn is zero. For an axis that is not vertical, east and
    north are rotated by the shortest rotation from up to that axis.
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

    def tilt_change(self, axis: Array) -> tuple[Harmonic, Harmonic]:
        """Change of the tilt towards east and north since the start; axis: (3,), level frame."""
        order = self.order if axis[2] >= -LEVEL else -self.order
        return (
            Harmonic(order, cosine=self.east, sine=-self.north),
            Harmonic(order, cosine=self.north, sine=self.east),
        )

    def table_rotations(
        self, turnings: Sequence[Turning], attitude: Array, instants: Instants
    ) -> Sequence[Turning]:
        if not turnings or not turnings[0].planned:
            return []
        axis = attitude @ turnings[0].axis
        (east, north), (to_east, to_north) = across(axis), self.tilt_change(axis)
        return [to_north.turning(-east, turnings[0]), to_east.turning(north, turnings[0])]

    def table_tilt(self, manoeuvre: Manoeuvre, set_attitude: Array) -> Array:
        axis = set_attitude @ manoeuvre.about
        (east, north), (to_east, to_north) = across(axis), self.tilt_change(axis)
        angle = np.asarray(0.0 if manoeuvre.step is None else manoeuvre.step.angle)
        to_north_now, to_east_now = (
            self.north + to_north.value(angle),
            self.east + to_east.value(angle),
        )
        return rotation_about(-east, to_north_now) @ rotation_about(north, to_east_now)
