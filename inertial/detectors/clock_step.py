"""A clock that was set while a log was recorded: from one record on all stamps are off."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.stamps import stamps_of
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

MIN_STEP_SHARE = 0.02  # of an interval: smaller steps have no effect
MIN_STEP_SIGMA = 10.0  # times what the stamps beside it scatter by, rms
SIDE_STAMPS = 32  # stamps on either side
MIN_SIDE_STAMPS = 8  # of them, where the log begins or ends
MIN_EVEN_STEPS = 4  # steps alike and evenly apart, which are the rounding of stamps
MAX_UNEVEN = 0.1  # of their size, and of the records from one to the next
MAX_RETURN_SHARE = 0.5  # of the step, by which the stamps beside it may take it back


class ClockStep(Detector):
    """One interval between two records that is shorter or longer, and is not made good again.

    A stamp that is late by itself is made good by the next one; what is longer by a whole interval
    is a gap, and what goes back is time that goes back.
    """

    name = "clock_step"
    cause = _("the clock of the receiver or logger was set, or it began to follow another clock")
    source = "design study, 5: a clock step is in no catalogue of effects, and must not be silent"
    costs = _("when things happened, by the step; angles and means are sums of samples and stay")
    unit = "s"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        events = list(self._steps(piece, log))
        if not _of_rounding(events):
            yield from events

    def _steps(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        off = np.diff(stamps.time) - stamps.apart * log.interval
        off[stamps.apart != 1] = np.nan
        for k in np.flatnonzero(np.abs(off) > MIN_STEP_SHARE * log.interval):
            before, behind = off[max(k - SIDE_STAMPS, 0) : k], off[k + 1 : k + 1 + SIDE_STAMPS]
            if min(np.isfinite(before).sum(), np.isfinite(behind).sum()) < MIN_SIDE_STAMPS:
                continue
            scatter = float(np.sqrt(np.nanmean(np.append(before, behind) ** 2)))
            taken_back = abs(float(np.nansum(before[-2:]) + np.nansum(behind[:2])))
            step = float(off[k])
            if abs(step) > MIN_STEP_SIGMA * scatter and taken_back < MAX_RETURN_SHARE * abs(step):
                place = int(stamps.place[k + 1])
                yield Event(
                    int(piece.record[place]),
                    int(piece.record[place]) + 1,
                    int(piece.line[place]),
                    float(stamps.time[k]),
                    float(stamps.time[k + 1]),
                    abs(step),
                    facts=step > 0,
                )

    def describe(self, event: Event, name: str) -> Description:
        later = "later" if event.facts else "earlier"
        size = significant(event.size * 1e3, 3)
        return Description(
            _(
                "{name}: from line {line} on, at {to_s} s, all stamps are {size} ms {later} "
                "than those of an even clock, and no sample is missing.",
                name=name,
                line=event.line,
                to_s=fixed(event.to_s, 3),
                size=size,
                later=later,
            ),
            _("What is taken against time is off by that much; angles and means hardly change."),
            _("All samples are used. Let the clock settle before recording."),
        )


def _of_rounding(events: Sequence[Event]) -> bool:
    """Whether steps are alike and evenly apart: no multiple of the stamps' unit is the interval."""
    if len(events) < MIN_EVEN_STEPS:
        return False
    sizes = np.array([event.size * (1 if event.facts else -1) for event in events])
    apart = np.diff([event.first for event in events])
    return bool(
        np.ptp(sizes) < MAX_UNEVEN * abs(sizes[0]) and np.ptp(apart) < MAX_UNEVEN * apart[0]
    )
