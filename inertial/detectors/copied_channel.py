"""Two axes of a sensor that read the same."""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from inertial.sensors import COLUMNS
from inertial.signal.detector import Description, Detector, Event, Log, Piece, channel_name
from inertial.text.messages import _
from inertial.text.numbers import whole

MIN_RECORDS = 1000
FIRST = 64  # records, by which most pairs are told apart at once
MIN_CHANGES = 100  # readings that differ from the one before


class CopiedChannel(Detector):
    """An axis that reads what another one reads, or the reverse, record by record.

    Noise of two axes is not the same a hundred times in a row; which of the two is the copy no
    reading tells, so neither is used.

    Cause: a column is written twice, or two axes are read from one register.
    """

    name = "copied_channel"
    source = "independent noise of the axes of a triad"
    unit = "records"
    severity = 3
    masks = True
    alike = "sensor"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for axes in COLUMNS.values():
            for pair in combinations(range(axes.start, axes.stop), 2):
                first = np.abs(piece.values[:FIRST, pair])
                if not np.array_equal(first[:, 0], first[:, 1], equal_nan=True):
                    continue
                values = piece.values[:, pair]
                values = values[np.isfinite(values).all(axis=1)]
                if len(values) < MIN_RECORDS:
                    continue
                one, other = values.T
                reversed_ = bool((one == -other).all())
                if not reversed_ and not (one == other).all():
                    continue
                if np.count_nonzero(np.diff(one)) >= MIN_CHANGES:
                    for channel, copied in (pair, pair[::-1]):
                        facts = copied, reversed_
                        size = float(len(values))
                        yield piece.event(0, len(piece), size, channel=channel, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        assert event.channel is not None
        copied, reversed_ = event.facts
        what = (
            _("the reverse of {other}", other=channel_name(copied))
            if reversed_
            else _("the same as {other}", other=channel_name(copied))
        )
        return Description(
            _(
                "{name}: {channel} reads {what}, in all of {records} records.",
                name=name,
                channel=channel_name(event.channel),
                what=what,
                records=whole(event.after - event.first),
            ),
            _("One of the two axes is not in the log: all that depends on it would be wrong."),
            _(
                "Both are masked, for which of them is the copy no reading tells. Look at the "
                "columns of the format, and at the registers that the logger reads; record again."
            ),
        )
