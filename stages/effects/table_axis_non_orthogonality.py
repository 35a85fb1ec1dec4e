"""Axes of a table that are not at right angles."""

from dataclasses import replace

import numpy as np

from stages.model.effect import Array, Effect, Parameter, Truth
from stages.model.motion import Motion, without_north
from stages.model.sizes import of_tables
from stages.notation.units import ARC_SECOND

SIDE = 0.5  # of the vertical along z, below which the case lies on a side


class TableAxisNonOrthogonality(Effect):
    """f −= δ × f, ω −= δ × ω: the case leans by δ on every side that the middle axis has set.

    The lean is fixed to the outer frame of the table, so it goes along with a turn about the
    vertical, unlike that of a table that is not level; it is alike on all sides, unlike the
    error of a position. The z axis of the case is taken to be upright where the middle axis is
    at zero: campaigns do not say how the case sits in the table.
    """

    name = "table_axis_non_orthogonality"
    cause = "the middle axis of the table is not at a right angle to its outer one"
    source = "IEEE Std 1554-2005, orthogonality of table axes"
    parameters = (
        Parameter("north", "rad", 1e-5, "lean towards where north was when the position was set"),
        Parameter("east", "rad", 1e-5, "lean towards where east was"),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        north = np.nan_to_num(motion.north_at_start)
        east = np.cross(north, motion.up_at_start)
        side = np.abs(motion.up_at_start[:, 2:]) < SIDE
        lean = np.cross(motion.up_at_start, values[0] * north + values[1] * east) * side
        return replace(
            truth,
            rate=truth.rate - np.cross(lean, motion.omega),
            force=truth.force - np.cross(lean, truth.force),
        )

    def blind(self, motion: Motion) -> str:
        return without_north(motion)
