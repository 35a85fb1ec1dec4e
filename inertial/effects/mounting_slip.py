"""An IMU that slips in its fixture while the table turns."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.effects.mounting_shift import MountingShift
from inertial.physics.effect import Effect, Scan, Truth, known_earth
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _


class MountingSlip(Effect):
    """As a shift of the mounting, f += f × θ, ω += ω × θ from then on, but the gyros see it happen.

    In one turn, which is scanned, the case turns by θ besides: ω += θ |θ'|/Θ, Θ the angle of that
    turn, and the shift goes with the share of it that is done. A shift that sets in between two
    manoeuvres adds nothing to any turn, and a turn that goes too far turns no axis of the case for
    those that follow.
    """

    name = "mounting_slip"
    cause = _(
        "the IMU slips in its fixture while the table turns: that turn goes further for the gyros, "
        "and its orientation in the fixture differs from then on"
    )
    source = MountingShift.source
    parameters = MountingShift.parameters
    sizes = MountingShift.sizes
    vector = True
    thinkable = MountingShift.thinkable
    scan = Scan("turn", "1", _("place of the turn among the manoeuvres of the plan"), between=False)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        own = self._turning(motion) & (np.floor(motion.visit) == self.value(motion))
        if not own.any():
            return truth
        whole = np.max(np.abs(motion.angle + motion.rate * motion.seconds / 2)[own])
        done = (motion.visit > motion.visit[own].max()).astype(np.float64)
        done[own] = np.abs(motion.angle[own]) / whole
        faster = np.where(own, np.abs(motion.rate) / whole, 0.0)
        turned = np.outer(done, values)
        upward, level = known_earth(truth, motion)
        seen = cross(motion.omega + upward + level, turned) + np.outer(faster, values)
        return replace(
            truth, rate=truth.rate + seen, force=truth.force + cross(truth.force, turned)
        )

    def grid(self, motion: Motion) -> Array:
        return np.unique(np.floor(motion.visit[self._turning(motion)]))

    @staticmethod
    def _turning(motion: Motion) -> Booleans:
        return np.asarray(motion.rate != 0)
