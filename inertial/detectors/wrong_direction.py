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
        if recorded.other_sense:
            turns = sum(do == "turn" for do in recorded.do)
            yield Deviation(None, "", -1.0, self.sensor, count=turns, repair=recorded.other_sense)
        for i, name in enumerate(recorded.name):
            ratio = ratio_of(recorded, i)
            if recorded.found[i] and ratio < 0 and name not in recorded.explained:
                yield self.of(recorded, i, ratio)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        if i is None:
            return _all_the_other_way(deviation, recorded)
        assert deviation.size is not None
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


def _all_the_other_way(deviation: Deviation, recorded: Recorded) -> Description:
    """All turns against the plan, while the gyros see the earth turn as they should."""
    earth = any(sign > 0 for sign in recorded.gyro_signs)
    seen = _(", while the gyros see the earth turn as it does") if earth else ""
    return Description(
        _(
            "All {count} turns are against the planned direction{seen}: the table counts its angle "
            "the other way.",
            count=deviation.count,
            seen=seen,
        ),
        _("Taken as planned, the scale errors of the gyros would be −200 %."),
        _(
            "All turns are taken the other way, on this condition. Correct the signs of degrees "
            "or rate in the plan; or confirm it by accept: [{repair}].",
            repair=deviation.repair,
        ),
    )
