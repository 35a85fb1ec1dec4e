"""A gyro bias that relaxes after each turn."""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import (
    Effect,
    Reading,
    Scan,
    Truth,
    by_grade,
    parameters_by_axis,
)
from inertial.physics.motion import Motion
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR

RELAXATION_TIMES = (5.0, 50.0)  # s, of τ: shorter is over as the rest begins, longer than a rest
RELAXATION_CANDIDATES = 4  # of τ, a factor of two apart; they are refined where one is found


@dataclass(frozen=True)
class Excited:
    """Shares of each stretch of what a turn excites, (n, …): while it lasts, and what is left."""

    turning: Array
    left: Array


def excited(since: Array, seconds: Array, constant: float) -> Excited:
    """The mean of 1 over the time in a turn, and of exp(−t/τ) over that after its end.

    since: s, from the end of the turn to the middle of each stretch, of any shape, NaN where there
    was none; seconds: their durations, s; constant: τ, s.
    """
    begin, end = (np.maximum(since + side * seconds / 2, 0.0) for side in (-1, 1))
    left = constant * (np.exp(-begin / constant) - np.exp(-end / constant)) / seconds
    turning = np.clip(0.5 - since / seconds, 0.0, 1.0)
    return Excited(np.nan_to_num(turning), np.nan_to_num(left))


class Relaxing(Effect):
    """What a turn excites in the gyros and what then relaxes, with a time constant τ, scanned."""

    scan = Scan("tau", "s", _("time constant of the relaxation"), smooth=True)
    of_stillness = True
    stays = _("it depends on the turns before the reading, which the reading does not tell")
    sizes = by_grade(DEGREE_PER_HOUR, 0.05, 1, 10, 50)

    def grid(self, motion: Motion) -> Array:
        return np.geomspace(*RELAXATION_TIMES, RELAXATION_CANDIDATES)

    def blind(self, motion: Motion) -> str:
        if (motion.since > 0).any():
            return ""
        return _("No rest after a turn is recorded in the log of that turn.")


class GyroRelaxation(Relaxing):
    """ω̃_i += b_i exp(−t/τ), t since the last turn about any axis ended; d_i while one lasts.

    What the turn strains or warms recovers as a state of first order (an anelastic solid, a warmed
    part), alike after either sense. How much of it there is during the turn depends on the cause:
    all of what the motion strains, none of what braking does. So it is a parameter of its own,
    which even turns of one rate tell: it adds to the angle alike in both senses.
    """

    name = "gyro_relaxation"
    cause = _("each turn strains or warms the sensor or its mount, which then recovers")
    source = "Nowick & Berry 1972, Anelastic Relaxation in Crystalline Solids, ch. 1"
    parameters = (
        *parameters_by_axis(
            "d", "rad/s", 0.1 * DEGREE_PER_HOUR, _("further bias of the {axis} gyro during a turn")
        ),
        *parameters_by_axis(
            "b", "rad/s", 0.1 * DEGREE_PER_HOUR, _("further bias of the {axis} gyro as a turn ends")
        ),
    )

    def added(self, truth: Truth, motion: Motion) -> Reading:
        known = np.where(np.isfinite(motion.since), motion.since, np.inf).min(axis=1)
        shares = excited(known, motion.seconds, self.value(motion))
        gyro = np.concatenate(
            [share[:, None, None] * np.eye(3) for share in (shares.turning, shares.left)], axis=2
        )
        return Reading(gyro, np.zeros_like(gyro))

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return reading.plus("gyro", self.added(truth, motion).gyro @ values)
