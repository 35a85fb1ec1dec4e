"""Inner axis of the table that leans towards the middle one."""

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
class TableInnerAxis(Effect):
    """The inner axis of the table, on which the case sits, leans towards the middle one by δ.

    home: unit vector, (3,), body axes, the direction of the inner axis; lean: δ, rad. Turns about
    the inner axis are about where it is; the others are about axes that do not lean.
    """

    lean: float
    home: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(parameters["lean_arcsec"] * ARCSECOND, direction(parameters.get("home", "+z")))

    def position_error(self, manoeuvre: Manoeuvre, set_attitude: Array, chance: Chance) -> Array:
        middle, _angle = middle_axis(manoeuvre, set_attitude, self.home)
        across = np.cross(set_attitude @ self.home, middle)
        return rotation_about(across / np.linalg.norm(across), np.asarray(self.lean))

    def axis_error(
        self, manoeuvre: Manoeuvre, set_attitude: Array, set_at: float, chance: Chance
    ) -> Array:
        if np.linalg.norm(np.cross(manoeuvre.about, self.home)) > 1e-9:
            return np.eye(3)
        return self.position_error(manoeuvre, set_attitude, chance)
