"""The stream of samples, one log at a time, and what is masked of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

# ---- The stream of samples, one log at a time.

Integers = NDArray[np.int64]
Columns = dict[str, NDArray[Any]]


def pieces(samples: Stream, columns: list[str]) -> Iterator[tuple[str, Columns]]:
    """Consecutive records of one log: its name, and the columns as arrays, NaN where empty."""
    for batch in samples.columns(["log", *columns]):
        logs = batch.column("log").dictionary_encode()
        names, index = logs.dictionary.to_pylist(), logs.indices.to_numpy()
        starts = [0, *(np.flatnonzero(np.diff(index)) + 1), len(index)]
        arrays = {name: _array(batch.column(name)) for name in columns}
        for start, end in pairwise(starts):
            if end > start:
                name = names[index[start]]
                yield name, {column: array[start:end] for column, array in arrays.items()}


def _array(column: pa.Array) -> NDArray[Any]:
    if pa.types.is_dictionary(column.type):
        column = column.dictionary_decode()
    return np.asarray(column.to_numpy(zero_copy_only=False))


def regular(records: int, length: int) -> tuple[Integers, Integers]:
    """Stretches of `length` records that cover a log of `records`."""
    first = np.arange(0, records, max(length, 1), dtype=np.int64)
    return first, np.append(first[1:], records).astype(np.int64)


def extents(samples: Stream) -> dict[str, int]:
    """For each log the number after its last record."""
    ends: dict[str, int] = {}
    for log, piece in pieces(samples, ["record"]):
        ends[log] = int(piece["record"][-1]) + 1
    return ends


# ---- What is not to be used of the samples, as every later stage honours it.

Booleans = NDArray[np.bool_]


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
