"""Means and sums over stretches of the records of a log, in one pass over the samples."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.masked_samples import Columns, Integers, Masked, Masks, pieces
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Stretches = Mapping[str, tuple[Integers, Integers]]

_OTHERS = ("time", "table_angle", "temperature")


@dataclass(frozen=True)
class Means:
    """Means over k stretches of records of one log.

    `mean`: (k, 6) in the order of CHANNELS, NaN where no sample is; `count`: (k,) samples, without
    masked records, a mean counted as the number of samples that it stands for; `first`, `last`:
    (k,) times.
    """

    mean: Array
    count: Array
    first: Array
    last: Array


@dataclass(frozen=True)
class Sums(Means):
    """What more there is to tell of k stretches of records of one log.

    `variance`, `least`, `most`: (k, 6); `records`: (k,) all records; `masked`: (k,) those that do
    not count; `time`, `table_angle`, `temperature`: (k,) means.
    """

    variance: Array
    least: Array
    most: Array
    records: Array
    masked: Array
    time: Array
    table_angle: Array
    temperature: Array


def means_over(
    samples: Stream, stretches: Stretches, masks: Masks | None = None
) -> dict[str, Means]:
    """Means of the channels over stretches of records, however many: 112 byte for each.

    Parameters
    ----------
    stretches : for each log the first records and the records after the last, (k,) each,
        ascending and without overlap
    masks : what does not count
    """
    totals = {log: _Means(len(first)) for log, (first, _) in stretches.items()}
    for log, part in _parts(samples, stretches, masks, ["time"]):
        totals[log].add(part, part.values)
    return {log: total.means() for log, total in totals.items()}


def sums_over(samples: Stream, stretches: Stretches, masks: Masks | None = None) -> dict[str, Sums]:
    """Means and extremes of the channels over stretches of records, as in `means_over`."""
    totals = {log: _Sums(len(first)) for log, (first, _) in stretches.items()}
    for log, part in _parts(samples, stretches, masks, list(_OTHERS)):
        totals[log].add(part)
    return {log: total.sums() for log, total in totals.items()}


@dataclass(frozen=True)
class _Part:
    """The n consecutive records of one log that lie in its stretches, those of a stretch together.

    `stretch`: (n,) where each lies; `starts`: (m,) the first of each stretch; `values`: (n, 6), NaN
    where masked; `share`: (n, 6), of how many samples a value is the mean, 0 where it does not
    count; `masked`: (n,) records that do not count; `others`: (n,) columns.
    """

    stretch: Integers
    starts: Integers
    values: Array
    share: Array
    masked: Booleans
    others: Columns

    @property
    def stretches(self) -> Integers:
        """The stretches that records lie in, (m,)."""
        return self.stretch[self.starts]


def _parts(
    samples: Stream, stretches: Stretches, masks: Masks | None, others: list[str]
) -> Iterator[tuple[str, _Part]]:
    for log, piece in pieces(samples, ["record", *others, "mean_of", *CHANNELS]):
        if log in stretches and len(stretches[log][0]):
            masked = masks.of(log, piece["record"]) if masks else None
            part = _within(piece, *stretches[log], masked, others)
            if len(part.stretch):
                yield log, part


def _within(
    piece: Columns, first: Integers, after: Integers, masked: Masked | None, others: list[str]
) -> _Part:
    record = piece["record"]
    stretch = np.searchsorted(first, record, side="right") - 1
    kept = (stretch >= 0) & (record < after[np.maximum(stretch, 0)])
    if masked is not None:
        kept &= ~masked.repeated
    stretch = stretch[kept]
    weight = np.nan_to_num(piece["mean_of"][kept], nan=1.0)
    values = np.column_stack([piece[channel][kept] for channel in CHANNELS])
    lost = np.zeros(len(stretch), bool) if masked is None else masked.lost[kept]
    if masked is not None:
        values[masked.channels[kept]] = np.nan
    there = ~np.isnan(values) & ~lost[:, None]
    return _Part(
        stretch,
        np.flatnonzero(np.diff(stretch, prepend=-1)),
        values,
        np.where(there, weight[:, None], 0.0),
        lost,
        {name: piece[name][kept] for name in others},
    )


class _Means:
    """What is added up while a log streams by."""

    def __init__(self, k: int) -> None:
        self.number, self.sum = np.zeros((k, 6)), np.zeros((k, 6))
        self.first, self.last = np.full(k, np.nan), np.full(k, np.nan)

    def add(self, part: _Part, values: Array) -> None:
        """Add records by their values, (n, 6)."""
        k, time = part.stretches, part.others["time"]
        self.first[k] = np.where(np.isnan(self.first[k]), time[part.starts], self.first[k])
        self.last[k] = time[np.append(part.starts[1:], len(time)) - 1]
        self.number[k] += np.add.reduceat(part.share, part.starts)
        counted = np.where(part.share > 0, part.share * values, 0.0)
        self.sum[k] += np.add.reduceat(counted, part.starts)

    def means(self) -> Means:
        with np.errstate(invalid="ignore", divide="ignore"):
            np.divide(self.sum, self.number, out=self.sum)
        return Means(self.sum, _samples(self.number), self.first, self.last)


class _Sums:
    """Likewise; the shift, a value of the stretch itself, keeps the squares small."""

    def __init__(self, k: int) -> None:
        self.away = _Means(k)
        self.records, self.masked = np.zeros(k), np.zeros(k)
        self.shift, self.square = np.full((k, 6), np.nan), np.zeros((k, 6))
        self.least, self.most = np.full((k, 6), np.inf), np.full((k, 6), -np.inf)
        self.other, self.others = np.zeros((2, k, len(_OTHERS)))

    def add(self, part: _Part) -> None:
        k, starts, values = part.stretches, part.starts, part.values
        self.records[k] += np.diff(starts, append=len(part.stretch))
        self.masked[k] += np.add.reduceat(part.masked.astype(np.float64), starts)
        self.shift[k] = np.where(np.isnan(self.shift[k]), values[starts], self.shift[k])
        there = part.share > 0
        away = np.where(there, values - np.nan_to_num(self.shift[part.stretch]), 0.0)
        self.away.add(part, away)
        self.square[k] += np.add.reduceat(part.share * away**2, starts)
        least = np.minimum.reduceat(np.where(there, values, np.inf), starts)
        most = np.maximum.reduceat(np.where(there, values, -np.inf), starts)
        self.least[k] = np.minimum(self.least[k], least)
        self.most[k] = np.maximum(self.most[k], most)
        others = np.column_stack([part.others[name] for name in _OTHERS])
        known = ~np.isnan(others)
        self.others[k] += np.add.reduceat(known.astype(np.float64), starts)
        self.other[k] += np.add.reduceat(np.where(known, others, 0.0), starts)

    def sums(self) -> Sums:
        empty = self.away.number == 0
        with np.errstate(invalid="ignore", divide="ignore"):
            square = self.square / self.away.number
            other = self.other / self.others
        away = self.away.means()
        return Sums(
            mean=np.nan_to_num(self.shift) + away.mean,
            count=away.count,
            first=away.first,
            last=away.last,
            variance=np.maximum(square - away.mean**2, 0.0),
            least=np.where(empty, np.nan, self.least),
            most=np.where(empty, np.nan, self.most),
            records=self.records,
            masked=self.masked,
            time=other[:, 0],
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
