"""Axes in each other's place from one record to the next."""

from collections.abc import Iterator

from inertial.signal.axis_permutations import describe_exchange, exchanges_of
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.text.messages import _


class AxisSwap(Detector):
    """Two axes of a triad that read each other's values from one record to the next.

    The IMU cannot do that: between two records it turns by far less by its gyros, and no
    turn ends in exactly the same three readings on other axes. Of the accelerometers it is seen
    in any attitude in which the two do not read the same. Of the gyros it is seen while the table
    turns; at rest only if their biases are clear of the noise. What was exchanged before the log
    began shows against the plan alone.
    """

    name = "axis_swap"
    cause = _("the driver or the logger wrote the fields in another order")
    source = "RAWIMUS writes z, −y, x: a reader that mixes orders does this"
    costs = _("scale factors and biases of both axes")
    unit = "samples"
    severity = 3
    masks = True
    sensor = "accel"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for exchange in exchanges_of(piece, log, self.sensor):
            if not exchange.permutation.in_place:
                yield exchange.event(piece, log)

    def describe(self, event: Event, name: str) -> Description:
        return describe_exchange(event, name, self.sensor)


class AxisSwapOfGyros(AxisSwap):
    """The same of the gyros."""

    sensor = "gyro"
