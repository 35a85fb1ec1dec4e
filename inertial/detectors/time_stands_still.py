"""Stamps that stay the same while the readings change."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import runs
from inertial.signal.stamps import kinds
from inertial.text.numbers import counted, fixed


class TimeStandsStill(Detector):
    """A record with the stamp of the one before, and other readings."""

    name = "time_stands_still"
    cause = "the clock of the logger hung, or counts in steps longer than a sample"
    source = "design study, 41c"
    costs = "when it was taken is not known, nor whether time passed with it"
    unit = "records"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        still = np.zeros(len(piece), bool)
        for places, _ in kinds(piece):
            still[places[1:]] = np.diff(piece.time[places]) == 0
        for start, end in runs(still):
            yield piece.event(start, end, float(end - start), facts=log.interval)

    def describe(self, event: Event, name: str) -> Description:
        single = event.size == 1
        time = event.size * event.facts
        return Description(
            f"{name}: {counted(int(event.size), 'record')} from line {event.line}"
            f" {'has' if single else 'have'} the stamp of the one before,"
            f" {fixed(event.from_s, 3)} s, but other readings.",
            f"Whether {time:.3g} s passed with {'it' if single else 'them'} is not known, so a sum"
            " over them, the angle of a turn, is unknown by the rate times as much; the mean of a"
            " rest stands.",
            f"{'It is' if single else 'They are'} masked. Look at the clock of the logger.",
        )
