"""A log that holds the readings of another."""

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.text.messages import _
from inertial.text.numbers import whole

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
