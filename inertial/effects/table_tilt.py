"""A table that is not level."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion, cross, without_north
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TableTilt(Effect):
    """f −= g (n north + e east): the table's vertical leans by n towards north and e towards east.

    The gyros feel the earth's rate as at a latitude that is n higher, its level part e further
    east: it counts where the lean is some tenths of a degree.

    Told from the tilt of a position by the turn: it stays fixed to the laboratory and so goes
    round in body axes. Without the azimuth of the positions there is no telling.
    """

    name = "table_tilt"
    cause = _("the base of the table is not level, so all its axes lean the same way")
    source = "IEEE Std 517-1974, table errors"
    parameters: tuple[Parameter, ...] = (
        Parameter("north", "rad", 2e-5, _("lean of the table's vertical towards north")),
        Parameter("east", "rad", 2e-5, _("lean of the table's vertical towards east")),
    )
    sizes = of_tables(ARC_SECOND, 3, 60)
    slope = 0.0  # of the course, 1/s: the gyros feel it

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        north = np.nan_to_num(motion.north)
        leant = values[0] * north + values[1] * cross(north, motion.up)
        whole = cross(motion.up, leant)
        lean = self.course(motion)[:, None] * whole
        earth = -cross(lean, truth.rate - motion.omega)
        upward = np.sum(earth * motion.up, axis=1, keepdims=True) * motion.up
        seen = np.where(motion.surveyed[:, None], earth, upward)  # else the gyros tell the level
        rate = truth.rate + seen + self.slope * whole
        return Truth(rate=rate, force=truth.force - cross(lean, truth.force))

    def course(self, motion: Motion) -> Array:
        """The share of the lean that there is in each stretch, (n,)."""
        return np.ones(len(motion.up))

    def level_rate_changes(self, up: float, level: float) -> Array:
        return np.array([-up, 0.0])

    def blind(self, motion: Motion) -> str:
        return without_north(motion)
