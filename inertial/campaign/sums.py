"""Means, sums and extremes over stretches of the records of a log, added up batch by batch."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.campaign.masked_samples import Batch, Masks, read_once
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

Stretches = Mapping[str, tuple[Integers, Integers]]

_AUXILIARY = ("time", "table_angle", "temperature")


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
    """Means of all columns over k stretches of records of one log, and the scatter of the channels.

    `variance`: (k, 6); `records`: (k,) all records; `masked`: (k,) those that do not count; `time`,
    `table_angle`, `temperature`: (k,) means.
    """

    variance: Array
    records: Array
    masked: Array
    time: Array
    table_angle: Array
    temperature: Array


@dataclass(frozen=True)
class _Part:
    """The n records of a batch that lie in stretches, those of a stretch together.

    `stretches`: (m,) the stretches that records lie in; `starts`: (m,) the first record of each;
    `rows`: (n,) or a slice, where the records are in the batch; `values`: (n, 6), NaN where masked;
    `share`: (n, 6), of how many samples a value is the mean, 0 where it does not count, or None
    where each value is one sample; `masked`: (n,) records that do not count, None if there are
    none.
    """

    stretches: Integers
    starts: Integers
    rows: slice | Integers
    values: Array
    share: Array | None
    masked: Booleans | None

    def __len__(self) -> int:
        return len(self.values)

    @property
    def lengths(self) -> Integers:
        """How many records each stretch has here, (m,)."""
        return np.diff(self.starts, append=len(self))

    def counted(self, values: Array) -> Array:
        """The sums of values, (n, 6), over the stretches, (m, 6)."""
        if self.share is not None:
            values = np.where(self.share > 0, self.share * values, 0)
        return np.asarray(np.add.reduceat(values, self.starts))


@dataclass(frozen=True)
class Rows:
    """The m stretches that records of a batch lie in, and the rows [start, end) of each, (m,)."""

    stretches: Integers
    starts: Integers
    ends: Integers


def rows_in(batch: Batch, stretches: Stretches) -> Rows | None:
    """Which stretches of its log a batch has records of; None if none."""
    if batch.log not in stretches:
        return None
    first, after = stretches[batch.log]
    record = batch["record"]
    start = int(np.searchsorted(after, record[0], side="right"))
    near = slice(start, max(start, int(np.searchsorted(first, record[-1], side="right"))))
    starts, ends = np.searchsorted(record, first[near]), np.searchsorted(record, after[near])
    there = np.flatnonzero(ends > starts)
    if not len(there):
        return None
    return Rows(there + near.start, starts[there], ends[there])


def _part_of(batch: Batch, stretches: Stretches, masks: Masks | None) -> _Part | None:
    """What of a batch lies in stretches, without what is masked; None if nothing does."""
    found = rows_in(batch, stretches)
    if found is None:
        return None
    lengths = found.ends - found.starts
    places, starts = found.stretches, np.cumsum(lengths) - lengths
    if (found.starts[1:] == found.ends[:-1]).all():
        rows: slice | Integers = slice(int(found.starts[0]), int(found.ends[-1]))
    else:
        rows = np.arange(lengths.sum()) + np.repeat(found.starts - starts, lengths)
    masked = None if masks is None else masks.of(batch.log, batch["record"][rows])
    if masked is not None and masked.repeated.any():
        kept = np.flatnonzero(~masked.repeated)
        if not len(kept):
            return None
        inside = np.repeat(places, lengths)[kept]
        rows = (np.arange(rows.start, rows.stop) if isinstance(rows, slice) else rows)[kept]
        masked = masked.part(kept)
        starts = np.flatnonzero(np.diff(inside, prepend=-1))
        places = inside[starts]
    values = batch.readings[rows]
    if masked is not None and masked.channels.any():
        values = np.where(masked.channels, np.nan, values)
    lost = masked.lost if masked is not None and masked.lost.any() else None
    return _Part(places, starts, rows, values, _share(batch, rows, values, lost), lost)


def _share(
    batch: Batch, rows: slice | Integers, values: Array, lost: Booleans | None
) -> Array | None:
    """Of how many samples each value is the mean, (n, 6), 0 where it does not count."""
    weight = np.nan_to_num(batch["mean_of"][rows], nan=1.0)
    there = ~np.isnan(values)
    if lost is None and there.all() and (weight == 1).all():
        return None
    if lost is not None:
        there &= ~lost[:, None]
    return np.where(there, weight[:, None], 0.0)


class _Times:
    """The first and the last time of k stretches."""

    def __init__(self, k: int) -> None:
        self.first, self.last = np.full(k, np.nan), np.full(k, np.nan)

    def add(self, stretches: Integers, first: Array, last: Array) -> None:
        """Take in the times at the beginning and at the end of some stretches, (m,)."""
        known = self.first[stretches]
        self.first[stretches] = np.where(np.isnan(known), first, known)
        self.last[stretches] = last


class TimesOver:
    """The first and the last time of stretches of records."""

    columns = ("time",)

    def __init__(self, stretches: Stretches) -> None:
        self._stretches = stretches
        self._times = {log: _Times(len(first)) for log, (first, _) in stretches.items()}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        if found := rows_in(batch, self._stretches):
            time = batch["time"]
            self._times[batch.log].add(found.stretches, time[found.starts], time[found.ends - 1])

    def result(self) -> dict[str, tuple[Array, Array]]:
        """By log, in the order of the stretches."""
        return {log: (times.first, times.last) for log, times in self._times.items()}


def _samples(number: Array) -> Array:
    """The samples of each stretch from those of its channels, (k, 6).

    By the gyros where they have any: an angle is their sum over time, whatever the accelerometers
    lack. Where the sensors come in rows of their own a stretch may hold one row more of the one
    than of the other.
    """
    accel, gyro = number[:, :3].max(axis=1), number[:, 3:].max(axis=1)
    return np.asarray(np.where(gyro > 0, gyro, accel))


class _Means:
    """Sums of the channels of one log over its k stretches."""

    def __init__(self, k: int) -> None:
        self.number, self.sum = np.zeros((k, 6)), np.zeros((k, 6))
        self.times = _Times(k)

    def add(self, part: _Part, batch: Batch, values: Array) -> None:
        """Add records by their values, (n, 6)."""
        k, time = part.stretches, batch["time"][part.rows]
        self.times.add(k, time[part.starts], time[part.starts + part.lengths - 1])
        if part.share is None:
            self.number[k] += part.lengths[:, None]
        else:
            self.number[k] += np.add.reduceat(part.share, part.starts)
        self.sum[k] += part.counted(values)

    def means(self) -> Means:
        with np.errstate(invalid="ignore", divide="ignore"):
            np.divide(self.sum, self.number, out=self.sum)
        return Means(self.sum, _samples(self.number), self.times.first, self.times.last)


class MeansOver:
    """Means of the channels over stretches of records, however many: 112 byte for each.

    Parameters
    ----------
    stretches : for each log the first records and the records after the last, (k,) each,
        ascending and without overlap
    masks : what does not count
    """

    columns = ("time", "mean_of", *CHANNELS)

    def __init__(self, stretches: Stretches, masks: Masks | None = None) -> None:
        self._stretches = stretches
        self._masks = masks
        self._means = {log: _Means(len(first)) for log, (first, _) in stretches.items()}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        if part := _part_of(batch, self._stretches, self._masks):
            self._means[batch.log].add(part, batch, part.values)

    def result(self) -> dict[str, Means]:
        """By log, in the order of the stretches."""
        return {log: means.means() for log, means in self._means.items()}


class _Sums:
    """Likewise, and of squares; the shift, a value of the stretch itself, keeps these small."""

    def __init__(self, k: int) -> None:
        self.shifted = _Means(k)
        self.records, self.masked = np.zeros(k), np.zeros(k)
        self.shift, self.square = np.full((k, 6), np.nan), np.zeros((k, 6))
        self.auxiliary, self.known = np.zeros((2, k, len(_AUXILIARY)))

    def add(self, part: _Part, batch: Batch) -> None:
        k, starts, values = part.stretches, part.starts, part.values
        self.records[k] += part.lengths
        if part.masked is not None:
            self.masked[k] += np.add.reduceat(part.masked.astype(np.float64), starts)
        self.shift[k] = np.where(np.isnan(self.shift[k]), values[starts], self.shift[k])
        shifted = values - np.repeat(np.nan_to_num(self.shift[k]), part.lengths, axis=0)
        if part.share is not None:
            shifted = np.where(part.share > 0, shifted, 0.0)
        self.shifted.add(part, batch, shifted)
        self.square[k] += part.counted(np.square(shifted, out=shifted))
        for column, name in enumerate(_AUXILIARY):
            auxiliary = batch[name][part.rows]
            known = ~np.isnan(auxiliary)
            if known.any():
                self.known[k, column] += np.add.reduceat(known.astype(np.float64), starts)
                self.auxiliary[k, column] += np.add.reduceat(np.where(known, auxiliary, 0), starts)

    def sums(self) -> Sums:
        with np.errstate(invalid="ignore", divide="ignore"):
            square = self.square / self.shifted.number
            auxiliary = self.auxiliary / self.known
        shifted = self.shifted.means()
        return Sums(
            mean=np.nan_to_num(self.shift) + shifted.mean,
            count=shifted.count,
            first=shifted.first,
            last=shifted.last,
            variance=np.maximum(square - shifted.mean**2, 0.0),
            records=self.records,
            masked=self.masked,
            time=auxiliary[:, 0],
            table_angle=auxiliary[:, 1],
            temperature=auxiliary[:, 2],
        )


class SumsOver:
    """Means of all columns over stretches of records, as in `MeansOver`, and the scatter."""

    columns = (*_AUXILIARY, "mean_of", *CHANNELS)

    def __init__(self, stretches: Stretches, masks: Masks | None = None) -> None:
        self._stretches = stretches
        self._masks = masks
        self._sums = {log: _Sums(len(first)) for log, (first, _) in stretches.items()}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        if part := _part_of(batch, self._stretches, self._masks):
            self._sums[batch.log].add(part, batch)

    def result(self) -> dict[str, Sums]:
        """By log, in the order of the stretches."""
        return {log: sums.sums() for log, sums in self._sums.items()}


@dataclass(frozen=True)
class Extremes:
    """The smallest and the largest readings in k stretches, (k, 6), NaN where there are none.

    `first`, `last`: (k,) times.
    """

    least: Array
    most: Array
    first: Array
    last: Array


class ExtremesOver:
    """The smallest and the largest readings in stretches of records."""

    columns = ("time", *CHANNELS)

    def __init__(self, stretches: Stretches) -> None:
        self._stretches = stretches
        self._times = TimesOver(stretches)
        self._extremes = {
            log: (np.full((len(first), 6), np.nan), np.full((len(first), 6), np.nan))
            for log, (first, _) in stretches.items()
        }

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        self._times.add(batch)
        found = rows_in(batch, self._stretches)
        if found is None:
            return
        least, most = self._extremes[batch.log]
        edges = np.column_stack([found.starts, found.ends]).ravel()
        edges = edges[:-1] if edges[-1] == len(batch) else edges
        k = found.stretches
        # Every other interval between edges lies between two stretches.
        least[k] = np.fmin(least[k], np.fmin.reduceat(batch.readings, edges)[::2])
        most[k] = np.fmax(most[k], np.fmax.reduceat(batch.readings, edges)[::2])

    def result(self) -> dict[str, Extremes]:
        """By log, in the order of the stretches."""
        times = self._times.result()
        return {log: Extremes(*pair, *times[log]) for log, pair in self._extremes.items()}


def extremes_over(samples: Stream, stretches: Stretches) -> dict[str, Extremes]:
    """Extremes over stretches of records of each log, in a pass of their own."""
    extremes = ExtremesOver(stretches)
    read_once(samples, [extremes])
    return extremes.result()
