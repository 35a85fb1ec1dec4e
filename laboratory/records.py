"""A log between the receiver and the disk: its records, and what faults have done to them."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from laboratory.arrays import Array, Counts
from laboratory.rawimu import Samples


class Touch(NamedTuple):
    """Records that one fault has touched, numbered from 0 in the log as it is now.

    Where first = after no record is touched, but the stamps jump before that record.
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
    temperature: Array  # K, (n,): of the IMU at the end of the sample
    units: Array  # (6,): the mean reading over a sample that makes one count, m/s² and rad/s
    interval: float  # s, of a sample
    touches: tuple[Touch, ...] = ()

    def __len__(self) -> int:
        return len(self.stamps)

    @property
    def samples(self) -> Samples:
        """What is written."""
        return Samples(self.stamps, self.counts[:, :3], self.counts[:, 3:])

    def at(self, rows: Counts) -> "Records":
        """Its records `rows`, (k,), which never decrease; one that comes twice is there twice.

        What faults have touched before stays with the records, and a jump before the first
        record that was behind it.
        """
        touches = []
        for touch in self.touches:
            first, after = np.searchsorted(rows, [touch.first, touch.after]).tolist()
            if first < after or touch.first == touch.after:
                touches.append(Touch(touch.fault, first, after))
        return replace(
            self,
            stamps=self.stamps[rows],
            counts=self.counts[rows],
            ends=self.ends[rows],
            temperature=self.temperature[rows],
            touches=tuple(touches),
        )

    def without(self, fault: str, rows: Counts) -> "Records":
        """What is left when a fault takes the records `rows`, (k,), away."""
        kept = np.ones(len(self), dtype=bool)
        kept[rows] = False
        behind = np.unique(np.cumsum(kept)[~kept])  # the records after the gaps
        return self.at(np.flatnonzero(kept)).jumped(fault, behind.tolist())

    def touched(self, fault: str, rows: Counts) -> "Records":
        """The same records, told that a fault has touched `rows`, (k,)."""
        inside = np.zeros(len(self) + 2, dtype=np.int8)  # with one more at both ends
        inside[rows + 1] = 1
        edges = np.flatnonzero(np.diff(inside)).reshape(-1, 2)
        touches = [Touch(fault, first, after) for first, after in edges.tolist()]
        return replace(self, touches=(*self.touches, *touches))

    def jumped(self, fault: str, rows: Iterable[int]) -> "Records":
        """The same records, told that a fault made the stamps jump before each of `rows`."""
        touches = [Touch(fault, row, row) for row in rows]
        return replace(self, touches=(*self.touches, *touches))
