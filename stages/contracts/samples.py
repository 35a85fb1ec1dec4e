"""The stream of samples, one log at a time."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from stages.contracts.parquet import Stream

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
