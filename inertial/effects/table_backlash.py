"""A table whose drive has play."""

import numpy as np

from inertial.arrays import Array
from inertial.effects.turn_angle_error import TurnAngleError
from inertial.physics.effect import Effect, Parameter, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

UPRIGHT = 0.01  # of a direction cosine: less is a level axis, whose own sense counts


class TableBacklash(Effect):
    """A turn of the other sense than the last one is by b less far: the drive first takes up play.

    The sense is about the axis of the table. Where another position is set between two turns, the
    drive is taken to stand still meanwhile, for inner axes or a hand set it. Turns of one sense in
    succession, or of two angles, tell it from a scale factor.
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
    thinkable = 20.0  # 10′, of a worm gear that is worn

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        for turn in turns_after_reversal(motion):
            truth = TurnAngleError().fixed(turn).moves(truth, motion, -values)
        return truth


def turns_after_reversal(motion: Motion) -> Array:
    """The places in the plan of the turns that go the other way than the turn before, (k,)."""
    upright = np.sum(np.broadcast_to(motion.about, motion.up.shape) * motion.up, axis=1)
    angles = np.where(upright < -UPRIGHT, -1, 1) * motion.rate * motion.seconds
    turning = motion.rate != 0
    places, turns = np.unique(np.floor(motion.visit[turning]), return_inverse=True)
    senses = np.sign(np.bincount(turns, angles[turning], minlength=len(places)))
    return np.asarray(places[1:][np.diff(senses) != 0])
