"""A table that does not stand quite where it is set."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion, all_level_axes, cross
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TablePositionError(Effect):
    """One set position is off by much more than the others: f += δ × f, ω += δ × ω there.

    Two tilts of every position are errors of the equations already, with the stated sigma of the
    table; what is sought is the position with which they cannot do, so the position is scanned.
    Backlash is that part of it which has the sign of the approach.
    """

    name = "table_position_error"
    cause = _("the position was set wrong, or encoder, backlash and clamping leave it off")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = tuple(
        Parameter(
            f"lean_{i}",
            "rad",
            2 * ARC_SECOND,
            _("lean about the {which} level axis at the start", which=which),
        )
        for i, which in ((1, "first"), (2, "second"))
    )
    sizes = of_tables(ARC_SECOND, 2, 30)
    thinkable = 1000.0  # a person who sets it may be degrees off
    scan = Scan("position", "1", _("place of the position among those of the plan"), between=False)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        lean = np.zeros_like(motion.up)
        own = motion.position == self.value(motion)
        lean[own] = values @ all_level_axes(motion.up[own])
        return Truth(
            rate=truth.rate + cross(lean, motion.omega),
            force=truth.force + cross(lean, truth.force),
        )

    def grid(self, motion: Motion) -> Array:
        return np.unique(motion.position)
