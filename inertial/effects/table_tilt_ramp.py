"""A table that tilts steadily."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.table_tilt import TableTilt
from inertial.physics.drift import without_clock
from inertial.physics.effect import Parameter, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, HOUR

TYPICAL = 2e-5 / HOUR


class TableTiltRamp(TableTilt):
    """As a table that is not level, but the lean is n t and e t, t since the first sample.

    The gyros feel the rate itself besides. Told from biases that drift as the tilt from a constant:
    it stays fixed to the laboratory, and so goes the other way where the IMU stands the other way.
    """

    name = "table_tilt_ramp"
    cause = _(
        "the floor or the base of the table gives way slowly, so all its axes lean more and more"
    )
    parameters = (
        Parameter("north", "rad/s", TYPICAL, _("drift of the table's vertical towards north")),
        Parameter("east", "rad/s", TYPICAL, _("drift of the table's vertical towards east")),
    )
    sizes = of_tables(ARC_SECOND / HOUR, 3, 60)
    slope = 1.0

    def course(self, motion: Motion) -> Array:
        return np.asarray(motion.time)

    def level_rate_changes(self, up: float, level: float) -> Array:
        return np.zeros(2)

    def blind(self, motion: Motion) -> str:
        return without_clock(motion) or super().blind(motion)
