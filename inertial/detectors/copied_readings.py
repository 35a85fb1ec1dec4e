"""Readings that are copies of others: two axes that read the same, a log that holds another."""

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from inertial.sensors import COLUMNS
from inertial.signal.detector import Description, Detector, Event, Log, Piece, channel_name
from inertial.text.messages import _
from inertial.text.numbers import whole

# ---- Two axes of a sensor that read the same.

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


# ---- A log that holds the readings of another.

MIN_WINDOWS = 5  # s: noise is not the same so often


class CopiedLog(Detector):
    """Two logs whose means over each second are equal to the last digit, in all channels.

    Cause: one file was copied, or exported, under two names. The manoeuvres of one of them were not
    recorded; where the plan has the same in both, the readings count twice.
    """

    name = "copied_log"
    source = "independent noise of two recordings"
    unit = "records"
    severity = 2

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        copies: dict[str, str] = {}
        for (first, one), (second, other) in combinations(logs.items(), 2):
            if second not in copies and _alike(one, other):
                copies[second] = first
                size = float(min(one.records, other.records))
                yield other.event(size, log=second, facts=first)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            _(
                "{name} holds the readings of {other}: {count} records are the same.",
                name=name,
                other=event.facts,
                count=whole(event.size),
            ),
            _(
                "One of the two was not recorded. A manoeuvre that is not as planned is left out; "
                "what fits the plan in both counts twice, and its sigmas are too small."
            ),
            _("Nothing is changed. Find the right file, or take one of the two out of the plan."),
        )


def _alike(one: Log, other: Log) -> bool:
    """Whether all that both have recorded is the same; not of readings that never change."""
    length = min(len(one.windows.mean), len(other.windows.mean)) - 1  # the last may be cut off
    return (
        length >= MIN_WINDOWS
        and np.array_equal(one.windows.mean[0], other.windows.mean[0], equal_nan=True)
        and np.array_equal(one.windows.mean[:length], other.windows.mean[:length], equal_nan=True)
        and bool(np.nansum(one.windows.variance[:length]) > 0)
    )
