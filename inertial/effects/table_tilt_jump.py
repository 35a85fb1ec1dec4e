"""A table that tilts once."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.mounting_shift import SHIFT_TIMES
from inertial.effects.table_tilt import TableTilt
from inertial.physics.drift import SettingIn
from inertial.physics.effect import Parameter, Scan, of_tables
from inertial.physics.motion import Motion, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableTiltJump(SettingIn, TableTilt):
    """As a table that is not level, but from a time t₀ on, which is scanned.

    So it is, too, where the zero of the level axis that carries all others is another from then
    on. The tilt stays fixed to the laboratory; a case that shifts in its fixture takes it along.
    """

    name = "table_tilt_jump"
    cause = _(
        "the base of the table settles or is pushed, or its outer level axis counts from another "
        "zero: all that it carries leans the same way from then on"
    )
    parameters = (
        Parameter(
            "north", "rad", 2e-5, _("lean of the table's vertical towards north from then on")
        ),
        Parameter("east", "rad", 2e-5, _("lean of the table's vertical towards east from then on")),
    )
    sizes = of_tables(ARC_SECOND, 10, 60)
    thinkable = 1000.0  # degrees, where an axis counts from another zero
    times = SHIFT_TIMES
    scan = Scan("t0", "s", _("time of the tilt since the first sample of all logs"))

    def course(self, motion: Motion) -> Array:
        return self.since(motion)

    def level_rate_changes(self, up: float, level: float) -> Array:
        return np.zeros(2)

    def blind(self, motion: Motion) -> str:
        return super().blind(motion) or without_north(motion)
