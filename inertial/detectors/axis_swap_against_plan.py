"""Exchanged axes, detected by the planned directions of gravity and axes of turns."""

from collections.abc import Iterator

from inertial.signal.detector import Description
from inertial.signal.misread_axes import describe_misread, deviation
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _


class AxisSwapAgainstPlan(PlanDetector):
    """Rests, or turns, that fit the plan only if two axes of a sensor are read as each other.

    The directions of gravity at the rests, and the axes of the turns, must be a signed permutation
    of the planned ones; where it is not the unit matrix, axes are exchanged. An IMU that is
    mounted askew by less than 25° is none of that.
    """

    name = "axis_swap"
    cause = _("the axes of the instrument, or the columns, are named in another order")
    source = "design study, 41d: the tables of gravity and of turns must be a signed permutation"
    costs = _("scale factors, cross terms and biases of these axes")
    unit = "manoeuvres"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for misread in recorded.misread:
            if not misread.axes.in_place:
                yield deviation(misread, recorded)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        return describe_misread(deviation.facts, recorded)
