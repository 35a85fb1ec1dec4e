"""A scale factor error of the table's rate."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _


class TableSpeedError(Effect):
    """θ(t) becomes θ((1 + e) t): ω += e (ω + t α), with t since the middle of the turn.

    A turn of a known angle is sooner over, but no larger: from rest to rest the gyros sum up the
    same. In a turn that is known by its rate alone it is a scale factor common to all gyros,
    but for the earth's rate. So it is observable with both kinds, or with the table's encoder.
    """

    name = "table_speed_error"
    cause = _("the clock of the drive, or its loop, keeps another speed")
    source = "IEEE Std 1554-2005, rate accuracy of tables"
    parameters = (Parameter("e", "1", 1e-4, _("relative error of the speed")),)
    sizes = of_tables(1e-6, 50, 1000)
    thinkable = 10.0
    absorbed_by = _("the angle of the table in each block, which only the gyros tell")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        # In the first and last block the table is at rest for half: so it adds up to nothing.
        turning = motion.rate * np.where(motion.ends, 0.5, 1.0)
        sooner = turning + motion.since_middle * motion.acceleration
        return replace(truth, rate=truth.rate + values[0] * sooner[:, None] * motion.about)
