"""The records of a log before they are written, and the faults that changed them."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from laboratory.arrays import Array, Counts
from laboratory.rawimu import Samples


class Mark(NamedTuple):
    """Records that one fault has changed, numbered from 0 in the present log.

    Where first = after no record is changed, but the stamps jump before that record.
    """

    fault: str  # its name
    first: int
    after: int  # the record after the last


@dataclass(frozen=True)
class Records:
    """n records of a log, as they would be written now."""

    stamps: Counts  # ns since the start of GPS time, (n,)
    counts: Counts  # (n, 6), columns as in CHANNELS
    ends: Counts  # ns since the start of GPS time, (n,): when the sample truly ended
    temperature: Array  # K, (n,): of the thermometer at the end of the sample
    table_angle: Array | None  # rad, (n,): as the encoder reads it; None where there is none
    units: Array  # (6,): the mean reading over a sample that makes one count, m/s² and rad/s
    interval: float  # s, of a sample
    marks: tuple[Mark, ...] = ()

    def __len__(self) -> int:
        return len(self.stamps)

    @property
    def samples(self) -> Samples:
        """What is written."""
        return Samples(self.stamps, self.counts[:, :3], self.counts[:, 3:])

    def at(self, rows: Counts) -> "Records":
        """The records `rows`, (k,), not decreasing; a row given twice is repeated.

        The marks of earlier faults stay with their records, that of a jump with the first
        remaining record after it.
        """
        marks = []
        for mark in self.marks:
            first, after = np.searchsorted(rows, [mark.first, mark.after]).tolist()
            if first < after or mark.first == mark.after:
                marks.append(Mark(mark.fault, first, after))
        return replace(
            self,
            stamps=self.stamps[rows],
            counts=self.counts[rows],
            ends=self.ends[rows],
            temperature=self.temperature[rows],
            table_angle=None if self.table_angle is None else self.table_angle[rows],
            marks=tuple(marks),
        )

    def without(self, fault: str, rows: Counts) -> "Records":
        """The log without the records `rows`, (k,), which a fault removes."""
        kept = np.ones(len(self), dtype=bool)
        kept[rows] = False
        behind = np.unique(np.cumsum(kept)[~kept])  # the records after the gaps
        return self.at(np.flatnonzero(kept)).jumped(fault, behind.tolist())

    def marked(self, fault: str, rows: Counts) -> "Records":
        """The same records, with `rows`, (k,), marked as changed by a fault."""
        inside = np.zeros(len(self) + 2, dtype=np.int8)  # with one more at both ends
        inside[rows + 1] = 1
        edges = np.flatnonzero(np.diff(inside)).reshape(-1, 2)
        marks = [Mark(fault, first, after) for first, after in edges.tolist()]
        return replace(self, marks=(*self.marks, *marks))

    def jumped(self, fault: str, rows: Iterable[int]) -> "Records":
        """The same records, with a jump of the stamps by a fault marked before each of `rows`."""
        marks = [Mark(fault, row, row) for row in rows]
        return replace(self, marks=(*self.marks, *marks))
