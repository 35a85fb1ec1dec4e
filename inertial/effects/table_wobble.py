"""An axis of the table that sways as it turns."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross, turned_all, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableWobble(Effect):
    """The axis leans by δ(θ), a vector that goes round twice a turn: f −= δ × f, ω += 2 θ' u × δ.

    In body axes δ goes round once, forward, where the vertical of a table that is not level goes
    round backward. A lean that goes round once is fixed to the case, and so part of the
    position's. θ counts from the start of the turn, which all turns about a vertical axis are
    taken to begin at the same mark of the table.
    """

    name = "table_wobble"
    cause = _("the bearing of the axis is not round: it sways twice a turn")
    source = "IEEE Std 1554-2005, wobble of table axes"
    parameters = (
        Parameter("north", "rad", 5e-6, _("lean of the axis towards north at the start of a turn")),
        Parameter("east", "rad", 5e-6, _("lean of the axis towards east at the start of a turn")),
    )
    sizes = of_tables(ARC_SECOND, 1, 10)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        north = np.nan_to_num(motion.north_at_start)
        east = cross(north, motion.up_at_start)
        first = cross(motion.up_at_start, values[0] * north + values[1] * east)
        lean = turned_all(first, motion.about, -motion.angle)
        return replace(
            truth,
            rate=truth.rate + 2 * cross(motion.omega, lean),
            force=truth.force - cross(lean, truth.force),
        )

    def blind(self, motion: Motion) -> str:
        return without_north(motion)
