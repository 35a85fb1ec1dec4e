"""Gyros whose readings are in another unit, or in the counts of another instrument."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, Rescaled
from inertial.signal.scale_factor import common_turn_ratio, turn_ratios
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant


class WrongScaleOfTurns(PlanDetector):
    """All turns are off by one ratio, in rate and in angle."""

    name = "wrong_scale_factor"
    cause = _("another unit, another full scale, or the counts of another instrument")
    source = "design study, 0: S0's log, read by the count of the iMAR-FSAS, turns at 0.17 °/s"
    costs = _("every parameter of the gyros is wrong by this ratio")
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.rescaled:
            yield Deviation(
                None,
                each.log,
                each.ratio,
                self.sensor,
                count=len(each.names),
                facts=each,
                repair=each.repair,
            )
        common = common_turn_ratio(recorded)
        if common is not None:
            ratio, why = common
            rate, _ = turn_ratios(recorded)
            number = int(np.isfinite(rate).sum())
            yield Deviation(None, "", ratio, self.sensor, count=number, facts=why)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        if isinstance(deviation.facts, Rescaled):
            return _undone(deviation.facts)
        ratio, why = deviation.size, deviation.facts
        assert ratio is not None
        rate, angle = turn_ratios(recorded)
        i = int(np.flatnonzero(np.isfinite(rate))[0])
        read = fixed(float(np.degrees(recorded.speed[i])), 5)
        far = ""
        if np.isfinite(angle[i]):
            far = _(" and by {fixed}°", fixed=fixed(float(np.degrees(recorded.moved[i])), 3))
        turns = (
            "The turn" if deviation.count == 1 else _("All {count} turns", count=deviation.count)
        )
        verb = "is" if deviation.count == 1 else "are"
        return Description(
            _(
                "{turns} {verb} {ratio} times as fast and as far as planned ({name}: {read} "
                "°/s{far} in place of {fixed} °/s): {why}.",
                turns=turns,
                verb=verb,
                ratio=significant(ratio, 5),
                name=recorded.name[i],
                read=read,
                far=far,
                fixed=fixed(float(np.degrees(recorded.rate[i])), 0),
                why=why,
            ),
            _(
                "Bias, scale factors and cross terms of the gyros are {ratio} times what they "
                "should be; no angle fits the plan, so {count} {verb} left out.",
                ratio=significant(ratio, 5),
                count=counted(deviation.count, "turn"),
                verb=verb,
            ),
            _(
                "Nothing is changed. Correct the unit, counts_per_unit or count size, or the "
                "name of the instrument in the campaign."
            ),
        )


def _undone(rescaled: Rescaled) -> Description:
    """Turns that fit the plan once the size of a count is set right."""
    where = _("in {log}", log=rescaled.log) if rescaled.log else _("in all logs")
    ratio = significant(rescaled.ratio, 5)
    return Description(
        _(
            "The gyros read {ratio} times what they should {where}, by {turns} of the plan: {why}.",
            ratio=ratio,
            where=where,
            turns=counted(len(rescaled.names), "turn"),
            why=rescaled.why,
        ),
        _(
            "Taken as recorded, bias, scale factors and cross terms of the gyros would be {ratio} "
            "times what they should be.",
            ratio=ratio,
        ),
        _(
            "The readings are divided by it before the estimation, on this condition. Correct the "
            "unit, counts_per_unit or count size, or the name of the instrument; or confirm it by "
            "accept: [{repair}].",
            repair=rescaled.repair,
        ),
    )
