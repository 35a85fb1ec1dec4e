"""A turn that is not as far as it is stated."""

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.physics.effect import Effect, Parameter, Scan, Truth, of_tables
from inertial.physics.motion import Motion, cross, turned_all
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND


class TurnAngleError(Effect):
    """One turn is by δ further than stated: ω += δ θ'/Θ in it, Θ the angle that is stated.

    At θ it is δ θ/Θ too far, and δ from its end until another position is set. By that gravity and
    the earth's rate turn the other way in the case, which accelerometers see in level turns.

    The turn is scanned. A turn there and one back alone tell it from an asymmetry of the scale
    factor of one gyro no more than this tells which of the two it was.
    """

    name = "turn_angle_error"
    cause = _("the turn was stopped elsewhere, or its angle is stated or read wrong")
    source = "IEEE Std 1554-2005, position accuracy of tables"
    parameters = (
        Parameter(
            "delta", "rad", 2 * ARC_SECOND, _("angle by which the turn is further than stated")
        ),
    )
    sizes = of_tables(ARC_SECOND, 2, 30)
    thinkable = 1000.0
    scan = Scan("turn", "1", _("place of the turn among the manoeuvres of the plan"), between=False)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        own = self._turning(motion) & (np.floor(motion.visit) == self.value(motion))
        if not own.any():
            return truth
        further, faster = self._after(motion, own).astype(np.float64), np.zeros(len(own))
        whole = np.max(np.abs(motion.angle + motion.rate * motion.seconds / 2)[own])
        further[own], faster[own] = motion.angle[own] / whole, motion.rate[own] / whole
        axis = np.broadcast_to(motion.about, motion.up.shape)[own][0]
        turned = turned_all(values[0] * axis, motion.about, motion.angle) * further[:, None]
        rate = truth.rate + values[0] * faster[:, None] * axis - cross(turned, truth.rate)
        return Truth(rate, truth.force - cross(turned, truth.force))

    @staticmethod
    def _after(motion: Motion, own: Booleans) -> Array:
        """The sense of the turn, ±1, where its end still holds: until another position is set."""
        place, end = motion.position[own][0], motion.visit[own][0]
        set_anew = motion.visit[(motion.visit > end) & (motion.position != place)]
        holds = (motion.visit > end) & (motion.visit < set_anew.min(initial=np.inf))
        return np.asarray(holds * np.sign(motion.rate[own].sum()))

    def grid(self, motion: Motion) -> Array:
        return np.unique(np.floor(motion.visit[self._turning(motion)]))

    @staticmethod
    def _turning(motion: Motion) -> Booleans:
        return np.asarray(motion.rate != 0)
