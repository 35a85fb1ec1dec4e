"""The zero of the middle axis of the table, which is another from a time on."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.axes import direction
from laboratory.chance import Chance
from laboratory.effects.effect import Effect
from laboratory.effects.table_axis_non_orthogonality import middle_axis
from laboratory.manoeuvre import Manoeuvre
from laboratory.rotation import rotation_about
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class TableZeroShift(Effect):
    """Positions that are set from a moment on, s, are turned by ζ about the middle axis.

    shift: ζ, rad; home: unit vector, (3,), body axes, the direction of the inner axis, about which
    turns go where it is then; turns about the middle axis are as before, and those about the outer
    one are about an axis that has not moved, so that it describes a cone in the case. upright: unit
    vector, (3,), body axes, the middle axis where home is up or down, if the outer axis turns the
    case there; None: the inner one does, and the middle axis points away from the zero mark.
    """

    shift: float
    moment: float
    home: Array
    upright: Array | None

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        upright = parameters.get("upright")
        return cls(
            parameters["shift_arcsec"] * ARCSECOND,
            parameters["at_s"],
            direction(parameters.get("home", "+z")),
            None if upright is None else direction(upright),
        )

    def later_error(self, manoeuvre: Manoeuvre, set_attitude: Array, set_at: float) -> Array:
        if set_at < self.moment:
            return np.eye(3)
        middle, _angle = middle_axis(manoeuvre, set_attitude, self.home)
        if self.upright is not None and self._is_upright(set_attitude):
            middle = set_attitude @ self.upright
        return rotation_about(middle, np.asarray(self.shift))

    def axis_error(
        self, manoeuvre: Manoeuvre, set_attitude: Array, set_at: float, chance: Chance
    ) -> Array:
        about_home = np.linalg.norm(np.cross(manoeuvre.about, self.home)) < 1e-9
        of_outer = self.upright is not None and self._is_upright(set_attitude)
        if about_home and not of_outer:
            return self.later_error(manoeuvre, set_attitude, set_at)
        return np.eye(3)

    def _is_upright(self, set_attitude: Array) -> bool:
        return bool(abs((set_attitude @ self.home)[2]) > 1 - 1e-9)
