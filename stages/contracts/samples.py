"""The stream of samples, one log at a time, and sums over stretches of its records."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from stages.contracts.masks import Masked, Masks
from stages.contracts.parquet import Stream
from stages.contracts.tables import CHANNELS

Array = NDArray[np.float64]
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


@dataclass(frozen=True)
class Sums:
    """Sums over k stretches of records of one log.

    `mean`, `variance`, `least`, `most`: (k, 6) in the order of CHANNELS, NaN where
    no sample is; `count`: (k,) samples, without masked records, a mean counted as the number
    of samples that it stands for; `records`: (k,) all records; `time`,
    `masked`: (k,) those that do not count; `table_angle`, `temperature`: (k,) means;
    `first`, `last`: (k,) times.
    """

    count: Array
    records: Array
    masked: Array
    mean: Array
    variance: Array
    least: Array
    most: Array
    time: Array
    first: Array
    last: Array
    table_angle: Array
    temperature: Array


_OTHERS = ("time", "table_angle", "temperature")


def sums_over(
    samples: Stream,
    stretches: Mapping[str, tuple[Integers, Integers]],
    masks: Masks | None = None,
) -> dict[str, Sums]:
    """Means and extremes of the channels over stretches of records, in one pass.

    Parameters
    ----------
    stretches : for each log the first records and the records after the last, (k,) each,
        ascending and without overlap
    masks : what does not count
    """
    totals = {log: _Totals(len(first)) for log, (first, _) in stretches.items()}
    for log, piece in pieces(samples, ["record", *_OTHERS, "mean_of", *CHANNELS]):
        if log in stretches and len(stretches[log][0]):
            masked = masks.of(log, piece["record"]) if masks else None
            totals[log].add(piece, *stretches[log], masked)
    return {log: total.sums() for log, total in totals.items()}


class _Totals:
    """What is added up while a log streams by; the shift keeps the squares small."""

    def __init__(self, k: int) -> None:
        self.records, self.masked = np.zeros(k), np.zeros(k)
        self.shift = np.full((k, 6), np.nan)
        self.number, self.sum, self.square = (np.zeros((k, 6)) for _ in range(3))
        self.least, self.most = np.full((k, 6), np.inf), np.full((k, 6), -np.inf)
        self.other = np.zeros((k, len(_OTHERS)))
        self.others = np.zeros((k, len(_OTHERS)))
        self.first, self.last = np.full(k, np.nan), np.full(k, np.nan)

    def add(self, piece: Columns, first: Integers, after: Integers, masked: Masked | None) -> None:
        record = piece["record"]
        stretch = np.searchsorted(first, record, side="right") - 1
        kept = (stretch >= 0) & (record < after[np.maximum(stretch, 0)])
        if masked is not None:
            kept &= ~masked.repeated
        if not kept.any():
            return
        stretch = stretch[kept]
        starts = np.flatnonzero(np.diff(stretch, prepend=-1))
        k = stretch[starts]
        np.add.at(self.records, k, np.diff(starts, append=len(stretch)))
        time = piece["time"][kept]
        self.first[k] = np.where(np.isnan(self.first[k]), time[starts], self.first[k])
        self.last[k] = time[np.append(starts[1:], len(stretch)) - 1]

        weight = np.nan_to_num(piece["mean_of"][kept], nan=1.0)
        values = np.column_stack([piece[channel][kept] for channel in CHANNELS])
        if masked is not None:
            weight = np.where(masked.lost[kept], 0.0, weight)
            self.masked[k] += np.add.reduceat(masked.lost[kept].astype(np.float64), starts)
            values[masked.channels[kept]] = np.nan
        there = ~np.isnan(values) & (weight > 0)[:, None]
        self.shift[k] = np.where(np.isnan(self.shift[k]), values[starts], self.shift[k])
        share = np.where(there, weight[:, None], 0.0)
        away = np.where(there, values - np.nan_to_num(self.shift[stretch]), 0.0)
        self.number[k] += np.add.reduceat(share, starts)
        self.sum[k] += np.add.reduceat(share * away, starts)
        self.square[k] += np.add.reduceat(share * away**2, starts)
        least = np.minimum.reduceat(np.where(there, values, np.inf), starts)
        most = np.maximum.reduceat(np.where(there, values, -np.inf), starts)
        self.least[k], self.most[k] = (
            np.minimum(self.least[k], least),
            np.maximum(self.most[k], most),
        )
        others = np.column_stack([piece[name][kept] for name in _OTHERS])
        known = ~np.isnan(others)
        self.others[k] += np.add.reduceat(known.astype(np.float64), starts)
        self.other[k] += np.add.reduceat(np.where(known, others, 0.0), starts)

    def sums(self) -> Sums:
        with np.errstate(invalid="ignore", divide="ignore"):
            away = self.sum / self.number
            variance = np.maximum(self.square / self.number - away**2, 0.0)
            other = self.other / self.others
        empty = self.number == 0
        return Sums(
            count=_samples(self.number),
            records=self.records,
            masked=self.masked,
            mean=np.nan_to_num(self.shift) + away,
            variance=variance,
            least=np.where(empty, np.nan, self.least),
            most=np.where(empty, np.nan, self.most),
            time=other[:, 0],
            first=self.first,
            last=self.last,
            table_angle=other[:, 1],
            temperature=other[:, 2],
        )


def _samples(number: Array) -> Array:
    """The samples of each stretch from those of its channels, (k, 6).

    Where the sensors come in rows of their own, a stretch may hold one row more of the
    one than of the other; then it is half a sample more.
    """
    by_sensor = np.column_stack([number[:, :3].max(axis=1), number[:, 3:].max(axis=1)])
    recorded = np.maximum((by_sensor > 0).sum(axis=1), 1)
    return np.asarray(by_sensor.sum(axis=1) / recorded)


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
