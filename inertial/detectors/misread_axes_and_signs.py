"""Axes in each other's place, or with the other sign: from one record to the next, or all along."""

from collections.abc import Iterator
from typing import ClassVar

from inertial.signal.axis_permutations import describe_exchange, exchanges_of
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.misread_axes import describe_misread, deviation
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded


class AxisSwap(Detector):
    """Two axes of a triad that read each other's values from one record to the next.

    The IMU cannot do that: between two records it turns by far less by its gyros, and no
    turn ends in exactly the same three readings on other axes. Of the accelerometers it is seen
    in any attitude in which the two do not read the same. Of the gyros it is seen while the table
    turns; at rest only if their biases are clear of the noise. What was exchanged before the log
    began shows against the plan alone.

    Cause: the driver or the logger wrote the fields in another order. Scale factors and biases of
    both axes are wrong.
    """

    name = "axis_swap"
    source = "RAWIMUS writes z, −y, x: a reader that mixes orders does this"
    unit = "samples"
    severity = 3
    masks = True
    sensor = "accel"
    in_place: ClassVar[bool] = False  # whether axes change their sign and not their place

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for exchange in exchanges_of(piece, log, self.sensor):
            if exchange.permutation.in_place is self.in_place:
                yield exchange.event(piece, log, self.sensor)

    def describe(self, event: Event, name: str) -> Description:
        return describe_exchange(event, name, self.sensor)


class AxisSwapOfGyros(AxisSwap):
    """The same of the gyros."""

    sensor = "gyro"


class SignFlip(AxisSwap):
    """One axis of a triad, or several, with the other sign from one record to the next.

    As with two axes exchanged, no motion does that between two records. It is seen where the axis
    reads something clear of its noise: of the gyros while the table turns, at rest only if the
    bias is clear. A sign that was wrong before the log began shows against the plan alone.

    Cause: the driver or the logger changed the convention of an axis. Its scale factor and bias are
    wrong.
    """

    name = "sign_flip"
    source = "RAWIMUS writes −y: a reader that forgets this, or does it twice"
    in_place = True


class SignFlipOfGyros(SignFlip):
    """The same of the gyros."""

    sensor = "gyro"


class AxisSwapAgainstPlan(PlanDetector):
    """Rests, or turns, that fit the plan only if two axes of a sensor are read as each other.

    The directions of gravity at the rests, and the axes of the turns, must be a signed permutation
    of the planned ones; where it is not the unit matrix, axes are exchanged. An IMU that is
    mounted askew by less than 25° is none of that.

    Cause: the axes of the instrument, or the columns, are named in another order. Scale factors,
    cross terms and biases of these axes are wrong.
    """

    name = "axis_swap"
    source = "design study, 41d: the tables of gravity and of turns must be a signed permutation"
    unit = "manoeuvres"
    severity = 3
    in_place: ClassVar[bool] = False

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for misread in recorded.misread:
            if misread.axes.in_place is self.in_place:
                yield deviation(misread, recorded)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        return describe_misread(deviation.facts, recorded)


class SignFlipAgainstPlan(AxisSwapAgainstPlan):
    """Rests, or turns, that fit the plan only if an axis of a sensor reads its negative.

    Cause: a sign of the raw fields is forgotten, or taken twice. Scale factor and bias of the axis
    are wrong.
    """

    name = "sign_flip"
    source = "design study, 41d: RAWIMUS −y; two wrong flips cancel, so the determinant is given"
    in_place = True
