"""A turn that is faster or slower than planned."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, Rescaled
from inertial.signal.scale_factor import common_turn_ratio, turn_ratios
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant


class WrongRate(PlanDetector):
    """A turn whose rate is not the planned one, where no ratio explains all of them."""

    name = "wrong_rate"
    cause = _("the rate of the plan, or of the table")
    source = "S0, table 5-6: the rate in the steady part"
    costs = _("a scale factor, where the rate is the reference")
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.restated:
            yield Deviation(
                None,
                "",
                each.ratio,
                self.sensor,
                count=len(each.names),
                facts=each,
                severity=1,
                repair=each.repair,
            )
        if common_turn_ratio(recorded) is not None:
            return
        rate, angle = turn_ratios(recorded)
        for i, ratio in enumerate(rate):
            if ratio > 0 and abs(ratio - 1) > recorded.tolerance:
                as_planned = abs(angle[i] - 1) <= recorded.tolerance
                yield self.of(recorded, i, float(ratio), severity=1 if as_planned else 3)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        if isinstance(deviation.facts, Rescaled):
            return _restated(deviation.facts)
        i, ratio = deviation.at, deviation.size
        assert i is not None and ratio is not None
        read, planned = np.degrees([recorded.speed[i], recorded.rate[i]]).tolist()
        _unused, angle = turn_ratios(recorded)
        if deviation.severity == 1:
            consequence = _(
                "Its angle is as planned ({fixed}°), so its scale factor holds; the rate is not "
                "used.",
                fixed=fixed(float(np.degrees(recorded.moved[i])), 2),
            )
        elif np.isfinite(angle[i]):
            consequence = _(
                "Its angle is {significant} times the planned one, so it is left out.",
                significant=significant(float(angle[i]), 4),
            )
        else:
            consequence = _(
                "Taken as planned, its scale error would be {fixed} %.",
                fixed=fixed((ratio - 1) * 100, 1),
            )
        return Description(
            _(
                "{name} turns at {read} °/s, {ratio} times the planned {planned} °/s; the other "
                "turns are not off by this ratio.",
                name=recorded.name[i],
                read=significant(read),
                ratio=significant(ratio, 5),
                planned=significant(planned),
            ),
            consequence,
            _("Correct the rate of the plan, or see what the table did."),
        )


def _restated(restated: Rescaled) -> Description:
    """Turns through their planned angles, all at one multiple of the planned rate."""
    return Description(
        _(
            "{turns} go through the planned angles at {ratio} times the planned rate: {why}.",
            turns=counted(len(restated.names), "turn"),
            ratio=significant(restated.ratio, 5),
            why=restated.why,
        ),
        _("The angles are as planned, so the scale factors hold."),
        _("The rates are taken as recorded. Correct the rate of the plan."),
    )
