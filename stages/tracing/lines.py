"""Where stretches of records stand in the logs: lines, bytes and times."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.campaign.masked_samples import Columns, pieces
from inertial.tables.parquet import Stream


@dataclass(frozen=True)
class Stretch:
    """Records `first` up to but without `after` of a log."""

    log: str
    first: int
    after: int


@dataclass(frozen=True)
class Lines:
    """The lines of a stretch: first and last, each with the byte where it begins and its time, s.

    Times are NaN where the log has none. `decoded`: how many lines became samples.
    """

    from_line: int
    to_line: int
    from_byte: int
    to_byte: int
    from_s: float
    to_s: float
    decoded: int

    @property
    def of_text(self) -> bool:
        """Whether they stand in the file as lines; rows of a container begin at no byte."""
        return self.to_byte > 0 or self.to_line == 1


def lines_of(samples: Stream, stretches: Sequence[Stretch]) -> dict[Stretch, Lines]:
    """The lines of each stretch, in one pass over the samples; none where all were refused."""
    found: dict[Stretch, Lines] = {}
    for log, piece in pieces(samples, ["record", "line", "offset", "time"]):
        for stretch in stretches:
            if stretch.log == log:
                ends = (stretch.first, stretch.after)
                first, after = np.searchsorted(piece["record"], ends).tolist()
                if after > first:
                    lines = _lines(piece, first, after - 1)
                    found[stretch] = _joined(found[stretch], lines) if stretch in found else lines
    return found


def _lines(piece: Columns, first: int, last: int) -> Lines:
    line, byte, time = piece["line"], piece["offset"], piece["time"]
    return Lines(
        from_line=int(line[first]),
        to_line=int(line[last]),
        from_byte=int(byte[first]),
        to_byte=int(byte[last]),
        from_s=float(time[first]),
        to_s=float(time[last]),
        decoded=last - first + 1,
    )


def _joined(before: Lines, then: Lines) -> Lines:
    return replace(
        before,
        to_line=then.to_line,
        to_byte=then.to_byte,
        to_s=then.to_s,
        decoded=before.decoded + then.decoded,
    )
