"""A table whose drive has play."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.turn_angle_error import TurnAngleError
from inertial.physics.effect import Effect, Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

KEPT, SET_ANEW = 0.0, 1.0


class TableBacklash(Effect):
    """A turn of the other sense than the last one is by b less far: the drive first takes up play.

    What the drive was last before a turn is known from the turn before it. Where another position
    was set in between, either the drive stood still meanwhile (0), or the position was set by it,
    from the side from which the next turn goes on (1). Turns of one sense in succession, or of two
    angles, tell it from a scale factor.
    """

    name = "table_backlash"
    cause = _("the drive of the table has play between the encoder and the platform")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (
        Parameter(
            "b", "rad", 2 * ARC_SECOND, _("by how much a turn is less far after one the other way")
        ),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)
    thinkable = 1000.0
    scan = Scan(
        "set_anew",
        "1",
        _("1 where the drive sets the positions, 0 where it stands still meanwhile"),
        between=False,
    )

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        for turn in self.after_reversal(motion):
            truth = TurnAngleError().fixed(turn).moves(truth, motion, -values)
        return truth

    def after_reversal(self, motion: Motion) -> list[float]:
        """The places in the plan of turns whose sense is not that of the turn before."""
        places, last, reversals = np.floor(motion.visit), None, []
        turning = motion.rate != 0
        upright = np.sum(np.broadcast_to(motion.about, motion.up.shape) * motion.up, axis=1)
        for place in np.unique(places[turning]):
            own = turning & (places == place)
            first = np.flatnonzero(own)[0]
            axis = np.sign(upright[first]) or 1.0
            sense = axis * np.sign(motion.rate[own].sum()), motion.position[first]
            known = last is not None and (self.value(motion) == KEPT or last[1] == sense[1])
            if known and last is not None and last[0] != sense[0]:
                reversals.append(float(place))
            last = sense
        return reversals

    def grid(self, motion: Motion) -> Array:
        return np.array([KEPT, SET_ANEW])
