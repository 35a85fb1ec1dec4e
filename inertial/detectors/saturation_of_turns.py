"""A gyro that follows turns up to one rate and no further, though it still scatters there."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Integers
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

MIN_TURNS = 2
MAX_SPREAD = 0.005  # of the rates at the limit, relative: half a degree per second of 100
MIN_BEYOND = 0.02  # by which the planned rate lies beyond, relative
MAX_SHORTER = 0.02  # of the planned time of a turn, relative


class SaturationOfTurns(PlanDetector):
    """Turns planned faster than one rate that are all recorded at that rate, in the planned time.

    What is cut off before noise is added, or before a filter, stands at no single reading: the plan
    alone tells it. A table that turned no faster would have taken longer for its angle.

    Cause: the turn went beyond the range of the gyro.
    """

    name = "saturation"
    source = "IEEE Std 528-2019, 'input limits'"
    unit = "°/s"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for axis, direction in zip("xyz", np.eye(3), strict=True):
            for i in _at_the_limit(recorded, direction).tolist():
                limit = abs(float(np.degrees(recorded.speed[i])))
                yield self.of(recorded, i, limit, axis=axis)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None and deviation.axis is not None
        own = _at_the_limit(recorded, np.eye(3)["xyz".index(deviation.axis)])
        return Description(
            _(
                "{name}: the gyro {axis} reads no more than {limit} °/s of {rate} °/s planned, as "
                "in {count} turns, though no time is missing: it is at the end of its range.",
                name=recorded.name[i],
                axis=deviation.axis,
                limit=significant(deviation.size, 4),
                rate=significant(float(np.degrees(np.abs(recorded.rate[i]))), 4),
                count=len(own),
            ),
            _(
                "Of {angle}° it shows {moved}°; taken for the whole angle, the scale factor would "
                "be wrong by {percent} %.",
                angle=fixed(float(np.degrees(recorded.angle[i])), 0),
                moved=fixed(float(np.degrees(recorded.moved[i])), 1),
                percent=fixed(100 * float(recorded.moved[i] / recorded.angle[i] - 1), 0),
            ),
            _(
                "It is not used. Turn more slowly, or choose a wider range. If the table turned at "
                "this rate itself and was stopped after the planned time, state both as they were."
            ),
        )


def _at_the_limit(recorded: Recorded, direction: np.ndarray) -> Integers:
    """The turns about an axis, either way, that the range of its gyro cuts off."""
    none = np.empty(0, np.int64)
    about = np.abs(recorded.about @ direction) > 1 - 1e-6
    turns = about & np.array([do == "turn" for do in recorded.do]) & recorded.found
    speed, rate = np.abs(recorded.speed), np.abs(recorded.rate)
    with np.errstate(invalid="ignore", divide="ignore"):
        whole_time = recorded.duration >= (1 - MAX_SHORTER) * np.abs(recorded.angle) / rate
        short = np.abs(recorded.moved) < (1 - MIN_BEYOND) * np.abs(recorded.angle)
        own = turns & ~recorded.complete & short & whole_time & (rate > (1 + MIN_BEYOND) * speed)
    if np.count_nonzero(own) < MIN_TURNS:
        return none
    limit = float(np.median(speed[own]))
    apart = np.abs(speed / limit - 1)
    beyond = turns & (speed > (1 + MAX_SPREAD) * limit)
    return np.flatnonzero(own) if (apart[own] <= MAX_SPREAD).all() and not beyond.any() else none
