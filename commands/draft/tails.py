"""The end of a log that holds no samples: what was filled up, or read from an empty memory."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from commands.draft.raw_log import Name, RawLog
from inertial.arrays import Array, Booleans

MIN_TAIL = 20  # rows that do not change, to be no chance
MIN_CLOCK_STEPS = 0.99  # share of steps in which a clock goes on
MIN_ZEROS = 3  # columns that a recorder fills up with zeros: the axes of a sensor


def without_tail(log: RawLog) -> RawLog:
    """The log without the rows at its end that hold no samples.

    Nothing changes in them but a clock, and they hold no number, or zeros, or a clock that stands:
    an IMU that rests is not so still.
    """
    names = list(log.columns)
    if not names or log.rows <= MIN_TAIL or log.kind == "rawimus":
        return log
    values = np.full((log.rows, len(names)), np.nan)
    for place, name in enumerate(names):
        values[: len(log.columns[name]), place] = log.columns[name]
    clocks = np.mean(np.diff(values, axis=0) > 0, axis=0) >= MIN_CLOCK_STEPS
    first = min(_unchanged_from(values), _unchanged_from(values[:, ~clocks]))
    if not 0 < first <= len(values) - MIN_TAIL or not _is_empty(values, first):
        return log
    columns: dict[Name, Array] = {name: log.columns[name][:first] for name in names}
    words: dict[Name, Sequence[str]] = {name: own[:first] for name, own in log.words.items()}
    return replace(log, columns=columns, words=words, left_out=len(values) - first)


def _unchanged_from(values: Array) -> int:
    """The first row, of (n, k), from which on all are the same; n where there are no columns."""
    if not values.size:
        return len(values)
    other = ~_same(values, values[-1]).all(axis=1)
    return int(np.flatnonzero(other)[-1]) + 1 if other.any() else 0


def _same(values: Array, last: Array) -> Booleans:
    return np.asarray((values == last) | (np.isnan(values) & np.isnan(last)))


def _is_empty(values: Array, first: int) -> bool:
    """Whether rows from `first` on, which do not change, hold no samples."""
    before, last = values[:first], values[-1]
    none = np.isnan(last) & (np.isfinite(before).mean(axis=0) > 0.5)
    zeros = (last == 0) & (before != 0).any(axis=0)
    went_on = np.mean(np.diff(before, axis=0) > 0, axis=0) >= MIN_CLOCK_STEPS
    stands = went_on & (values[first] == last)
    return bool(none.any() or zeros.sum() >= MIN_ZEROS or stands.any())
