"""A turn the other way."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import fixed


class WrongDirection(PlanDetector):
    """A turn that is opposite to the planned direction by its gyro."""

    name = "wrong_direction"
    cause = _("the sign of the planned angle, or the table turned the other way")
    source = "S0: shun and ni; judge a turn by the sign on the gyro, not by the word"
    costs = _("the sign of a scale factor")
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for i, name in enumerate(recorded.name):
            ratio = ratio_of(recorded, i)
            if recorded.found[i] and ratio < 0 and name not in recorded.explained:
                yield self.of(recorded, i, ratio)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        name, turned, planned = recorded.name[i], recorded.moved[i], recorded.angle[i]
        unit = "°"
        if not np.isfinite(turned * planned):
            turned, planned, unit = recorded.speed[i], recorded.rate[i], " °/s"
        far = [fixed(float(np.degrees(turned)), 2), fixed(float(np.degrees(planned)), 0)]
        return Description(
            _(
                "{name} turns against the planned direction: by {far}{unit} in place of "
                "{far_2}{unit}.",
                name=name,
                far=far[0],
                unit=unit,
                far_2=far[1],
            ),
            _(
                "Taken as planned, its scale error would be {fixed} %; it is left out of all "
                "methods.",
                fixed=fixed((deviation.size - 1) * 100, 0),
            ),
            _("Correct the sign of degrees or rate, or the axes of the gyros."),
        )


def ratio_of(recorded: Recorded, i: int) -> float:
    """Recorded over planned, of the rate or else of the angle; NaN where either is not known."""
    by_rate = float(recorded.speed[i] / recorded.rate[i]) if recorded.rate[i] else np.nan
    if np.isfinite(by_rate) or not recorded.angle[i]:
        return by_rate
    return float(recorded.moved[i] / recorded.angle[i])
