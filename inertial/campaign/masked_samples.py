"""The stream of samples in batches of one log each, what is set right, and what is masked."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise
from typing import Any, Protocol

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from inertial.arrays import Array, Booleans, Integers
from inertial.tables import CHANNELS
from inertial.tables.parquet import Stream

Columns = dict[str, NDArray[Any]]

CENSORED = "censored "  # before the name of a channel


@dataclass(frozen=True, eq=False)
class Batch:
    """Consecutive records of one log, n of them: columns of the samples, (n,), NaN where empty."""

    log: str
    columns: Columns

    def __len__(self) -> int:
        return len(self.columns["record"])

    def __getitem__(self, column: str) -> NDArray[Any]:
        return self.columns[column]

    @cached_property
    def readings(self) -> Array:
        """The six channels, (n, 6), in the order of CHANNELS; whoever changes them takes a copy."""
        return np.column_stack([self.columns[channel] for channel in CHANNELS])


class Accumulator(Protocol):
    """What takes in the samples of all logs batch by batch, in their order, and sums them up."""

    @property
    def columns(self) -> Sequence[str]:
        """The columns of the samples that it needs, `record` apart."""

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""


class Repairs:
    """What sets the readings of each log right: axes, signs and sizes of its six channels.

    Whoever reads samples after segment hands it over, so that no stage takes a reading under
    the name of another axis, or in another unit.
    """

    def __init__(self, table: pd.DataFrame) -> None:
        # By log: for each channel the recorded one, (6,), and by what that is multiplied, (6,).
        self._by_log: dict[str, tuple[Integers, Array]] = {}
        for (log, _repair), rows in table.groupby(["log", "repair"], sort=False):
            source, factor = self.channels(str(log))
            own, by = np.arange(len(CHANNELS)), np.ones(len(CHANNELS))
            names = ("sensor", "axis", "from_axis", "factor")
            for sensor, axis, recorded, times in rows[list(names)].itertuples(index=False):
                channel = CHANNELS.index(f"{sensor}_{axis}")
                own[channel], by[channel] = CHANNELS.index(f"{sensor}_{recorded}"), times
            self._by_log[str(log)] = source[own], by * factor[own]

    def channels(self, log: str) -> tuple[Integers, Array]:
        """For each channel of a log the recorded one, (6,), and its factor, (6,)."""
        return self._by_log.get(log, (np.arange(len(CHANNELS)), np.ones(len(CHANNELS))))

    def readings(self, log: str, recorded: Array) -> Array:
        """The six channels of records of a log, (n, 6), from those recorded."""
        if log not in self._by_log:
            return recorded
        source, factor = self._by_log[log]
        return np.asarray(recorded[:, source] * factor)

    def channel_masks(self, log: str, recorded: Booleans) -> Booleans:
        """Which readings are masked, (n, 6), where the masks name the recorded channels."""
        return recorded if log not in self._by_log else recorded[:, self._by_log[log][0]]

    def columns(self, log: str, recorded: Columns) -> Columns:
        """Columns of the samples of a log; with one channel of a sensor goes the whole sensor."""
        own = [channel for channel in CHANNELS if channel in recorded]
        if log not in self._by_log or not own:
            return recorded
        nothing = np.full(len(recorded[own[0]]), np.nan)
        six = np.column_stack([recorded.get(channel, nothing) for channel in CHANNELS])
        set_right = dict(zip(CHANNELS, self.readings(log, six).T, strict=True))
        return {**recorded, **{channel: set_right[channel] for channel in own}}


def read_once(
    samples: Stream, accumulators: Sequence[Accumulator], repairs: Repairs | None = None
) -> None:
    """One pass over the samples for any number of accumulators."""
    columns = dict.fromkeys(chain(["record"], *(each.columns for each in accumulators)))
    for log, piece in pieces(samples, list(columns), repairs):
        batch = Batch(log, piece)
        for accumulator in accumulators:
            accumulator.add(batch)


def pieces(
    samples: Stream, columns: list[str], repairs: Repairs | None = None
) -> Iterator[tuple[str, Columns]]:
    """Consecutive records of one log: its name, and the columns as arrays, NaN where empty."""
    for batch in samples.columns(["log", *columns]):
        for log, piece in _by_log(batch, columns):
            yield log, piece if repairs is None else repairs.columns(log, piece)


def rows_between(samples: Stream, first: int, after: int, columns: list[str]) -> Iterator[Batch]:
    """The rows [first, after) of the table, without a pass over the others."""
    for part in samples.rows(first, after, ["log", *columns]):
        for log, piece in _by_log(part, columns):
            yield Batch(log, piece)


def _by_log(batch: pa.RecordBatch, columns: list[str]) -> Iterator[tuple[str, Columns]]:
    logs = batch.column("log").dictionary_encode()
    names, index = logs.dictionary.to_pylist(), logs.indices.to_numpy()
    starts = [0, *(np.flatnonzero(np.diff(index)) + 1), len(index)]
    arrays = {name: _array(batch.column(name)) for name in columns}
    for start, end in pairwise(starts):
        if end > start:
            yield names[index[start]], {name: array[start:end] for name, array in arrays.items()}


def _array(column: pa.Array) -> NDArray[Any]:
    if pa.types.is_dictionary(column.type):
        column = column.dictionary_decode()
    return np.asarray(column.to_numpy(zero_copy_only=False))


class RecordIndex:
    """Which rows of the table hold which records of a log."""

    columns: Sequence[str] = ()

    def __init__(self) -> None:
        self._rows = 0
        self._batches: dict[str, list[tuple[int, int, int, int]]] = {}

    def add(self, batch: Batch) -> None:
        """Note the first and the last record of a batch, and its rows."""
        record, rows = batch["record"], self._rows
        self._rows += len(batch)
        own = self._batches.setdefault(batch.log, [])
        own.append((int(record[0]), int(record[-1]) + 1, rows, self._rows))

    def rows(self, log: str, first: int, after: int) -> tuple[int, int]:
        """The rows among which the records [first, after) are; more where records are lacking."""
        spans = []
        for start, end, row, last_row in self._batches.get(log, ()):
            if start < after and first < end:
                # Records ascend, with gaps where lines were refused.
                begin = row + max(first - start, 0) if end - start == last_row - row else row
                stop = min(last_row, row + max(after - start, 0))
                spans.append((begin, stop))
        return (spans[0][0], spans[-1][1]) if spans else (0, 0)


def regular(records: int, length: int) -> tuple[Integers, Integers]:
    """Stretches of `length` records that cover a log of `records`."""
    first = np.arange(0, records, max(length, 1), dtype=np.int64)
    return first, np.minimum(first + max(length, 1), records)


@dataclass(frozen=True)
class Masked:
    """What is masked of n records.

    lost: (n,), time passed, but the readings are not to be used; repeated: (n,), it repeats
    another record, and no time passed; channels: (n, 6), this reading is not to be used; censored:
    (n, 6), of these, it is masked for its value, so the mean of the readings beside it is biased.
    """

    lost: Booleans
    repeated: Booleans
    channels: Booleans
    censored: Booleans

    @property
    def whole(self) -> Booleans:
        """Records of which nothing is to be used, (n,)."""
        return self.lost | self.repeated

    def part(self, places: Integers) -> "Masked":
        """The same of some of the records."""
        return Masked(
            self.lost[places], self.repeated[places], self.channels[places], self.censored[places]
        )


class Masks:
    """The masks of a campaign, by log; with its repairs, of the channels as set right."""

    def __init__(self, table: pd.DataFrame, repairs: Repairs | None = None) -> None:
        self._repairs = repairs
        self._by_log: dict[str, list[tuple[str, Integers, Integers]]] = {}
        kinds = (table["sensor"] + "_" + table["axis"]).where(table["sensor"].notna(), "")
        kinds = kinds.mask(table["repeated"].astype(bool), "repeated")
        kinds = kinds.mask(table["censored"].astype(bool), CENSORED + kinds)
        for (log, kind), rows in table.groupby([table["log"], kinds.rename("kind")]):
            edges = [rows[name].to_numpy(np.int64) for name in ("from_record", "to_record")]
            self._by_log.setdefault(str(log), []).append((str(kind), edges[0], edges[1]))

    def of(self, log: str, record: Integers) -> Masked:
        """What is masked of these records of a log."""
        lost, repeated = np.zeros(len(record), bool), np.zeros(len(record), bool)
        channels, censored = np.zeros((2, len(record), len(CHANNELS)), bool)
        for kind, first, after in self._by_log.get(log, ()):
            here = inside(record, first, after)
            if kind == "repeated":
                repeated |= here
            elif kind.startswith(CENSORED):
                censored[:, CHANNELS.index(kind.removeprefix(CENSORED))] |= here
            elif kind:
                channels[:, CHANNELS.index(kind)] |= here
            else:
                lost |= here
        channels = channels | censored
        if self._repairs is not None:
            channels = self._repairs.channel_masks(log, channels)
            censored = self._repairs.channel_masks(log, censored)
        return Masked(lost & ~repeated, repeated, channels, censored)

    def censored_between(self, log: str, edges: Integers) -> Booleans:
        """Which channels have readings that are censored from edge to edge, (k, 6).

        Parameters
        ----------
        edges : (k + 1,), records of the log, ascending
        """
        k = len(edges) - 1
        begun = np.zeros((k + 1, len(CHANNELS)))
        for kind, first, after in self._by_log.get(log, ()):
            if kind.startswith(CENSORED):
                channel = CHANNELS.index(kind.removeprefix(CENSORED))
                starts = np.searchsorted(edges, first, side="right") - 1
                np.add.at(begun[:, channel], np.clip(starts, 0, k), 1)
                np.add.at(begun[:, channel], np.searchsorted(edges[:k], after), -1)
        censored = np.cumsum(begun, axis=0)[:k] > 0
        return censored if self._repairs is None else self._repairs.channel_masks(log, censored)


@dataclass(frozen=True, eq=False)
class MaskedSamples:
    """The samples, and the tables of what sets them right and of what is masked of them."""

    samples: Stream
    channel_repairs: pd.DataFrame
    masks: pd.DataFrame

    @cached_property
    def repairs(self) -> Repairs:
        """What sets the readings right."""
        return Repairs(self.channel_repairs)

    @cached_property
    def masked(self) -> Masks:
        """What is masked of the readings as set right."""
        return Masks(self.masks, self.repairs)


def inside(records: Integers, first: Integers, after: Integers) -> Booleans:
    """Which records lie in one of the stretches [first, after)."""
    if not len(first):
        return np.zeros(len(records), bool)
    order = np.argsort(first)
    first, after = first[order], np.maximum.accumulate(after[order])
    stretch = np.searchsorted(first, records, side="right") - 1
    return np.asarray((stretch >= 0) & (records < after[np.maximum(stretch, 0)]))
