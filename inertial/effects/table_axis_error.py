"""A table whose axis does not stand quite where it is set."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.effects.table_position_error import TablePositionError
from inertial.physics.effect import Truth
from inertial.physics.motion import Motion, all_level_axes, are_parts_of_turns, cross, turned_all
from inertial.text.messages import _


class TableAxisError(TablePositionError):
    """The axis of one set position is off with the case on it: f += δ × f, δ fixed to the earth.

    So it is on a table of several axes, where an outer axis sets the direction of the inner one. In
    body axes δ goes round as the table turns, unlike a `table_position_error`, which is fixed to
    the case; in a rest they are the same, and only positions with turns are scanned. The turn is
    about its axis as before, so of the rates only that of the earth changes, by less than is seen.
    """

    name = "table_axis_error"
    cause = _("the outer axis of the table was set wrong, so the axis of the turns leans with it")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        lean = np.zeros_like(motion.up)
        own = motion.position == self.value(motion)
        about = np.broadcast_to(motion.about, motion.up.shape)[own]
        at_start = values @ all_level_axes(motion.up_at_start[own])
        lean[own] = turned_all(at_start, about, motion.angle[own])
        return replace(truth, force=truth.force + cross(lean, truth.force))

    def grid(self, motion: Motion) -> Array:
        return np.unique(motion.position[are_parts_of_turns(motion.angle)])
