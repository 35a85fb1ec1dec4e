"""Reversed axes, detected by the planned directions of gravity and senses of turns."""

from collections.abc import Iterator

from inertial.signal.detector import Description
from inertial.signal.misread_axes import describe_misread, deviation
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _


class SignFlipAgainstPlan(PlanDetector):
    """Rests, or turns, that fit the plan only if an axis of a sensor reads its negative."""

    name = "sign_flip"
    cause = _("a sign of the raw fields is forgotten, or taken twice")
    source = "design study, 41d: RAWIMUS −y; two wrong flips cancel, so the determinant is given"
    costs = _("scale factor and bias of the axis")
    unit = "manoeuvres"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for misread in recorded.misread:
            if misread.axes.in_place:
                yield deviation(misread, recorded)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        return describe_misread(deviation.facts, recorded)
