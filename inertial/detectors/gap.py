"""Samples that were never written."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.stamps import disorders, stamps_of
from inertial.text.numbers import fixed

MIN_GAP_INTERVALS = 1.5  # median intervals: what is no jitter of the stamps any more
SIDE_STAMPS = 4  # stamps on either side that must agree


class Gap(Detector):
    """An interval between two records in which at least one sample is missing."""

    name = "gap"
    cause = "the logger lost samples, or the file was not written whole"
    source = "S0, lines 2192 and 2193 of its z counter-clockwise log: 11.98 s are missing"
    costs = "a sum over it lacks what was not recorded: the scale factor of a turn"
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
        missing = "1 sample is" if event.size == 1 else f"{event.size:.0f} samples are"
        return Description(
            f"{name}: {missing} missing between {fixed(event.from_s, 3)} s and"
            f" {fixed(event.to_s, 3)} s; line {event.line} is the first after them.",
            "A sum over this stretch lacks what was not recorded; means of a rest hardly change.",
            "A turn whose steady part has the gap is bridged; one whose ramp has it is left out.",
        )
