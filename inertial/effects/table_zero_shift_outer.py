"""The same of a table whose outer axis turns the case where the inner one is vertical."""

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.effects.table_zero_shift import TableZeroShift
from inertial.physics.drift import SettingIn
from inertial.physics.effect import Parameter
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableZeroShiftOuter(TableZeroShift):
    """As `table_zero_shift`, but where z is up or down the outer axis turns the case.

    There m goes round with the case, and turns are about an axis that the case leans from: to the
    gyros it is a cross term if all turns about z come after the shift.
    """

    name = "table_zero_shift_outer"
    cause = _(
        "the encoder or a coupling of the middle axis of the table slips, or its zero is set "
        "anew, and where the inner axis is vertical the outer one turns the case"
    )
    parameters = (
        *(
            Parameter(
                f"upright_{axis}",
                "rad",
                2 * ARC_SECOND,
                _("turn about the {axis} axis where the inner axis is vertical", axis=axis),
            )
            for axis in "xy"
        ),
        TableZeroShift.parameters[-1],
    )

    def blind(self, motion: Motion) -> str:
        return SettingIn.blind(self, motion)

    def _is_turned(self, upright: Booleans) -> Booleans:
        return ~upright

    def _upright(self, up: Array, north: Array, values: Array) -> Array:
        return np.broadcast_to(np.append(values, 0.0), up.shape)
