"""Samples that were never written."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.stamps import disorders, stamps_of
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed

MIN_GAP_INTERVALS = 1.5  # median intervals: what is no jitter of the stamps any more
SIDE_STAMPS = 4  # stamps on either side that must agree


class Gap(Detector):
    """An interval between two records in which at least one sample is missing."""

    name = "gap"
    cause = _("the logger lost samples, or the file was not written whole")
    source = "S0, lines 2192 and 2193 of its z counter-clockwise log: 11.98 s are missing"
    costs = _("a sum over it lacks what was not recorded: the scale factor of a turn")
    unit = "samples"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        stamps = stamps_of(piece, log)
        # Stamps that are out of order make no gap, but their records are there.
        ordered = np.ones(len(stamps), bool)
        for disorder in disorders(stamps.time, piece.reached, log.interval):
            ordered[disorder.start : disorder.end] = False
        place, time = np.flatnonzero(ordered), stamps.time[ordered]
        for k in np.flatnonzero(np.diff(time) > MIN_GAP_INTERVALS * log.interval):
            later = time[k + 1 : k + 1 + SIDE_STAMPS]
            earlier = time[max(k + 1 - SIDE_STAMPS, 0) : k + 1][::-1]
            # A stamp that is late or early by itself makes no gap: those beside it do not agree.
            surely = (later - log.interval * np.arange(len(later))).min()
            surely -= (earlier + log.interval * np.arange(len(earlier))).max()
            missing = round((time[k + 1] - time[k]) / log.interval) - (place[k + 1] - place[k])
            if missing > 0 and surely > MIN_GAP_INTERVALS * log.interval:
                after = int(stamps.place[place[k + 1]])
                yield Event(
                    int(piece.record[after]),
                    int(piece.record[after]),
                    int(piece.line[after]),
                    float(time[k]),
                    float(time[k + 1]),
                    float(missing),
                )

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            plural(
                "{name}: {count} sample is missing between {from_s} s and {to_s} s; line {line} is"
                " the first after it.",
                "{name}: {count} samples are missing between {from_s} s and {to_s} s; line {line}"
                " is the first after them.",
                round(event.size),
                name=name,
                from_s=fixed(event.from_s, 3),
                to_s=fixed(event.to_s, 3),
                line=event.line,
            ),
            _("A sum over the gap lacks what was not recorded; means of a rest hardly change."),
            _(
                "A turn with the gap in its steady part is interpolated; one with the gap in a ramp"
                " is left out."
            ),
        )
