"""What is not to be used of the samples, as every later stage honours it."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.tables import CHANNELS

Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Masked:
    """What is masked of n records.

    lost: (n,), time passed, but the readings are not to be used; repeated: (n,), it repeats
    another record, and no time passed; channels: (n, 6), this reading is not to be used.
    """

    lost: Booleans
    repeated: Booleans
    channels: Booleans

    @property
    def whole(self) -> Booleans:
        """Records of which nothing is to be used, (n,)."""
        return self.lost | self.repeated


class Masks:
    """The masks of a campaign, asked log by log."""

    def __init__(self, table: pd.DataFrame) -> None:
        self._by_log: dict[str, list[tuple[str, Integers, Integers]]] = {}
        kinds = table["channel"].where(table["channel"].notna(), "")
        kinds = kinds.mask(table["repeated"].astype(bool), "repeated")
        for (log, kind), rows in table.groupby([table["log"], kinds.rename("kind")]):
            edges = [rows[name].to_numpy(np.int64) for name in ("from_record", "to_record")]
            self._by_log.setdefault(str(log), []).append((str(kind), edges[0], edges[1]))

    def of(self, log: str, record: Integers) -> Masked:
        """What is masked of these records of a log."""
        lost, repeated = np.zeros(len(record), bool), np.zeros(len(record), bool)
        channels = np.zeros((len(record), len(CHANNELS)), bool)
        for kind, first, after in self._by_log.get(log, ()):
            here = inside(record, first, after)
            if kind == "repeated":
                repeated |= here
            elif kind:
                channels[:, CHANNELS.index(kind)] |= here
            else:
                lost |= here
        return Masked(lost & ~repeated, repeated, channels)


def inside(records: Integers, first: Integers, after: Integers) -> Booleans:
    """Which records lie in one of the stretches [first, after)."""
    if not len(first):
        return np.zeros(len(records), bool)
    order = np.argsort(first)
    first, after = first[order], np.maximum.accumulate(after[order])
    stretch = np.searchsorted(first, records, side="right") - 1
    return np.asarray((stretch >= 0) & (records < after[np.maximum(stretch, 0)]))
