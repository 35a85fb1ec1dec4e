"""An axis that reads its negative from one record to the next."""

from collections.abc import Iterator

from inertial.signal.axis_permutations import describe_exchange, exchanges_of
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.text.messages import _


class SignFlip(Detector):
    """One axis of a triad, or several, with the other sign from one record to the next.

    As with two axes exchanged, no motion does that between two records. It is seen where the axis
    reads something clear of its noise: of the gyros while the table turns, at rest only if the
    bias is clear. A sign that was wrong before the log began shows against the plan alone.
    """

    name = "sign_flip"
    cause = _("the driver or the logger changed the convention of an axis")
    source = "RAWIMUS writes −y: a reader that forgets this, or does it twice"
    costs = _("scale factor and bias of the axis")
    unit = "samples"
    severity = 3
    masks = True
    sensor = "accel"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for exchange in exchanges_of(piece, log, self.sensor):
            if exchange.permutation.in_place:
                yield exchange.event(piece, log)

    def describe(self, event: Event, name: str) -> Description:
        return describe_exchange(event, name, self.sensor)


class SignFlipOfGyros(SignFlip):
    """The same of the gyros."""

    sensor = "gyro"
