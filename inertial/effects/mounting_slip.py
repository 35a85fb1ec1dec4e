"""An IMU that slips in its fixture while the table turns."""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.effects.mounting_shift import SHIFT_TIMES, MountingShift
from inertial.physics.drift import without_clock
from inertial.physics.effect import Scan, Truth
from inertial.physics.motion import Motion
from inertial.text.messages import _

TIMES_OF_A_TURN = 2, 9  # that are tried, as many as all turns leave


class MountingSlip(MountingShift):
    """A shift of the mounting within a turn, t₀ scanned there, and the gyros see it happen.

    In that turn the case turns by θ besides: ω += θ |θ'|/Θ, Θ the angle of the turn. About its axis
    the blocks take their angle from the gyros, so only the whole turn shows how far. A shift that
    sets in between two manoeuvres adds nothing to any turn, and a turn that goes too far turns no
    axis of the case for those that follow.
    """

    name = "mounting_slip"
    cause = _(
        "the IMU slips in its fixture while the table turns: that turn goes further for the gyros, "
        "and its orientation in the fixture differs from then on"
    )
    scan = Scan("t0", "s", _("time of the slip since the first sample of all logs"))
    by_share = False

    def grid(self, motion: Motion) -> Array:
        turns = np.unique(np.floor(motion.visit[_turning(motion)]))
        if without_clock(motion):
            return turns
        least, most = TIMES_OF_A_TURN
        count = int(np.clip(SHIFT_TIMES // max(len(turns), 1), least, most))
        share = (np.arange(count) + 0.5) / count
        spans = [_span(motion, np.floor(motion.visit) == turn) for turn in turns]
        return np.array([first + share * (last - first) for first, last in spans]).ravel()

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        moved = super().moves(truth, motion, values)
        own = self._turn(motion)
        if not own.any():
            return moved
        whole = np.max(np.abs(motion.angle + motion.rate * motion.seconds / 2)[own])
        faster = np.where(own, np.abs(motion.rate) / whole, 0.0)
        return replace(moved, rate=moved.rate + np.outer(faster, values))

    def _turn(self, motion: Motion) -> Booleans:
        """The stretches of the turn in which it slips; all false between two turns."""
        at, visit = self.value(motion), np.floor(motion.visit)
        if without_clock(motion):
            return np.asarray(_turning(motion) & (visit == at))
        for turn in np.unique(visit[_turning(motion)]):
            own = _turning(motion) & (visit == turn)
            first, last = _span(motion, own)
            if first <= at <= last:
                return np.asarray(own)
        return np.zeros(len(visit), bool)


def _turning(motion: Motion) -> Booleans:
    return np.asarray(motion.rate != 0)


def _span(motion: Motion, own: Booleans) -> tuple[float, float]:
    """When some turning stretches begin, and when they end, s."""
    own = own & _turning(motion)
    half = motion.seconds[own] / 2
    return float((motion.time[own] - half).min()), float((motion.time[own] + half).max())
