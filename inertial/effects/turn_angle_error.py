"""A turn that is not as far as it is stated."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.physics.effect import Effect, Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TurnAngleError(Effect):
    """One turn is by δ further than stated: ω += δ θ'/Θ in it, Θ the angle that is stated.

    The turn is scanned. A turn there and one back alone tell it from an asymmetry of the scale
    factor of one gyro no more than this tells which of the two it was.
    """

    name = "turn_angle_error"
    cause = _("the turn was stopped elsewhere, or its angle is stated or read wrong")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (
        Parameter("delta", "rad", 2 * ARC_SECOND, _("by which the turn is further than stated")),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)
    thinkable = 1000.0
    scan = Scan("turn", "1", _("place of the turn among the manoeuvres of the plan"), between=False)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        own = self._turning(motion) & (np.floor(motion.visit) == self.value(motion))
        ends = np.abs(motion.angle + motion.rate * motion.seconds / 2)[own]
        share = np.zeros(len(own))
        share[own] = motion.rate[own] / np.max(ends, initial=0.0)
        return replace(truth, rate=truth.rate + values[0] * share[:, None] * motion.about)

    def grid(self, motion: Motion) -> Array:
        return np.unique(np.floor(motion.visit[self._turning(motion)]))

    @staticmethod
    def _turning(motion: Motion) -> Booleans:
        return np.asarray(motion.rate != 0)
