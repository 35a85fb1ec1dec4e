"""What the gyros still read after a turn has stopped."""

from collections.abc import Iterator

import numpy as np
from scipy.special import stdtr

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND

MIN_TURNS = 4  # whose scatter tells the mean from chance
MAX_CHANCE = 1e-4  # of clean campaigns


class MotionAfterTurns(PlanDetector):
    """In the rest after a turn the gyros read another rate than before it, with the sense of turns.

    By Student's test of what whole turns have in common, so that noise of any colour is allowed
    for. A drift does not change its sign with the sense of the turn.

    Cause: the table overshoots and creeps back, or the gyros themselves relax after a turn. The
    angle from start to stop is not the planned one, or the biases of the rests are not those of the
    turns; gyros in a turn about the vertical cannot tell which.
    """

    name = "motion_after_turns"
    source = "IEEE Std 1293-2018, 12: readings are taken once the table has settled"
    unit = "rad"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        angle = recorded.after_stop[np.isfinite(recorded.after_stop)]
        if len(angle) < MIN_TURNS or (np.sign(angle) == np.sign(angle[0])).mean() < 1:
            return
        mean, sigma = float(np.mean(angle)), float(np.std(angle, ddof=1) / np.sqrt(len(angle)))
        if sigma > 0 and 2 * float(stdtr(len(angle) - 1, -abs(mean) / sigma)) < MAX_CHANCE:
            yield Deviation(None, "", mean, self.sensor, count=len(angle), facts=sigma)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        whole = float(np.nanmin(np.abs(recorded.angle)))
        return Description(
            _(
                "After {count} turns have stopped the gyros read a rotation of {angle} ± {sigma} "
                "arcsec more, {sense}: the table overshoots and settles, or the gyros relax.",
                count=deviation.count,
                angle=significant(abs(deviation.size) / ARC_SECOND, 3),
                sigma=significant(deviation.facts / ARC_SECOND, 2),
                sense=_("with the turn") if deviation.size > 0 else _("back against the turn"),
            ),
            _(
                "If it is the table, the angle from start to stop is off by as much, and scale "
                "factors by up to {ppm} ppm; if it is the gyros, biases at rest are not those in "
                "turns.",
                ppm=significant(1e6 * abs(deviation.size) / whole, 2),
            ),
            _(
                "Nothing is changed. Record the same turn with a slower acceleration and with a "
                "longer rest after it: what the table does becomes less with the first, what gyros "
                "do stays."
            ),
        )
