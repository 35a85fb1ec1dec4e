"""Axes in each other's place, seen by what the plan says of gravity and of the turns."""

from collections.abc import Iterator

from inertial.signal.detector import Description
from inertial.signal.misread_axes import deviation, misread_words
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded


class AxisSwapAgainstPlan(PlanDetector):
    """Rests, or turns, that fit the plan only if two axes of a sensor are read as each other.

    The directions of gravity at the rests, and the axes of the turns, must be a signed permutation
    of the planned ones; where it is not the unit matrix, axes are taken for others. An IMU that is
    mounted askew by less than 25° is none of that.
    """

    name = "axis_swap"
    cause = "the axes of the instrument, or the columns, are named in another order"
    source = "design study, 41d: the tables of gravity and of turns must be a signed permutation"
    costs = "scale factors, cross terms and biases of these axes"
    unit = "manoeuvres"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for one in recorded.misread:
            if not one.axes.in_place:
                yield deviation(one, recorded)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        return misread_words(deviation.facts, recorded)
