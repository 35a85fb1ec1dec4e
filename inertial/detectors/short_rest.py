"""A rest of which little was recorded."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

MIN_DURATION_SHARE = 1 / 3  # of the planned time


class ShortRest(PlanDetector):
    """A rest that lasts less than a third of what was planned."""

    name = "short_rest"
    cause = _("the log was cut off, or is an excerpt")
    source = "S0: white noise averages out with the root of the time at rest"
    costs = _("the sigma of its mean")
    unit = "s"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i, what in enumerate(recorded.do):
            short = recorded.duration[i] < MIN_DURATION_SHARE * recorded.seconds[i]
            if what == "rest" and recorded.found[i] and recorded.duration[i] > 0 and short:
                yield self.of(recorded, i, float(recorded.duration[i]))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        planned = float(recorded.seconds[i])
        times = significant(float(np.sqrt(planned / deviation.size)), 2)
        return Description(
            _(
                "{name} rests for {size} s of the {planned} s planned.",
                name=recorded.name[i],
                size=significant(deviation.size, 3),
                planned=fixed(planned, 0),
            ),
            _(
                "What white noise leaves in its mean is {times} times what was planned.",
                times=times,
            ),
            _("It is used with the sigma that it has. Record it whole."),
        )
