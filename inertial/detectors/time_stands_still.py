"""Stamps that stay the same while the readings change."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import runs
from inertial.signal.stamps import kinds
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed


class TimeStandsStill(Detector):
    """A record with the stamp of the one before, and other readings."""

    name = "time_stands_still"
    cause = _("the clock of the logger hung, or counts in steps longer than a sample")
    source = "design study, 41c"
    costs = _("when it was taken is not known, nor whether time passed with it")
    unit = "records"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        still = np.zeros(len(piece), bool)
        for places, _channels in kinds(piece):
            still[places[1:]] = np.diff(piece.time[places]) == 0
        for start, end in runs(still):
            yield piece.event(start, end, float(end - start), facts=log.interval)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            plural(
                "{name}: {count} record from line {line} has the stamp of the record before,"
                " {stamp} s, but other readings.",
                "{name}: {count} records from line {line} have the stamp of the record before,"
                " {stamp} s, but other readings.",
                int(event.size),
                name=name,
                line=event.line,
                stamp=fixed(event.from_s, 3),
            ),
            _(
                "Whether {time} s passed meanwhile is not known, so the angle of a turn is"
                " uncertain by the rate times this time; the mean of a rest is not affected.",
                time=f"{event.size * event.facts:.3g}",
            ),
            _("These records are masked. Check the clock of the logger."),
        )
