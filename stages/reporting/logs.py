"""Every log as it is drawn: its envelope over time, its phases, and what is missing of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.tables import CHANNELS
from stages.reporting.rows import Record, records

Array = NDArray[np.float64]
Stretch = tuple[float, float]

MOST_MISSING = 50  # stretches that are marked in one log


@dataclass(frozen=True)
class Log:
    """One log as it is drawn: envelope over time, phases, missing stretches."""

    name: str
    start: Array  # of each row of the envelope, s, or records where there is no time
    end: Array
    least: dict[str, Array]
    most: dict[str, Array]
    phases: tuple[Record, ...]
    missing: tuple[Stretch, ...]  # the longest of them
    lost: float  # s, of all gaps, from the record before to the one after
    timed: bool
    records: int

    @property
    def static(self) -> bool:
        """Whether the plan has the table at rest all through."""
        return bool(self.phases) and all(row["phase"].startswith("rest") for row in self.phases)

    @property
    def extent(self) -> Stretch:
        """From its first to its last sample."""
        return (float(self.start.min()), float(self.end.max())) if len(self.start) else (0.0, 0.0)

    def rows(self, index: NDArray[np.integer[Any]]) -> Log:
        """The rows of the envelope that `index` lists, as often as it does."""
        return replace(
            self,
            start=self.start[index],
            end=self.end[index],
            least={name: values[index] for name, values in self.least.items()},
            most={name: values[index] for name, values in self.most.items()},
        )


def logs(
    traces: pd.DataFrame, segments: pd.DataFrame, clocks: pd.DataFrame, gaps: pd.DataFrame
) -> list[Log]:
    """Every log with its envelope, the phases of its manoeuvres and what is missing."""
    clock = {row["log"]: row for row in records(clocks)}
    phases = records(segments)
    stated = gaps[["from_s", "to_s"]].to_numpy(dtype=np.float64)
    found = []
    for name, rows in traces.groupby("log", sort=False, observed=True):
        log = str(name)
        timed = not bool(rows["from_s"].isna().any() or rows["to_s"].isna().any())
        columns = ("from_s", "to_s") if timed else ("from_record", "to_record")
        start, end = (rows[column].to_numpy(dtype=np.float64) for column in columns)
        interval = clock.get(log, {}).get("interval")
        own_gaps = stated[(gaps["log"] == log).to_numpy()]
        missing = _missing(start, end, interval, own_gaps) if timed else []
        longest = tuple(sorted(_longest(missing, MOST_MISSING)))
        lost = sum(b - a for a, b in missing)
        least, most = (
            {
                channel: rows[f"{prefix}_{channel}"].to_numpy(dtype=np.float64)
                for channel in CHANNELS
            }
            for prefix in ("least", "most")
        )
        own = tuple(
            row | {"start": row[columns[0]], "end": row[columns[1]]}
            for row in phases
            if row["log"] == log and row[columns[0]] is not None and row[columns[1]] is not None
        )
        count = int(clock.get(log, {}).get("records") or rows["to_record"].max())
        drawn = Log(log, start, end, least, most, own, longest, lost, timed, count)
        found.append(_cut(drawn))
    return found


def _missing(start: Array, end: Array, interval: float | None, gaps: Array) -> list[Stretch]:
    """Stretches without samples: the gaps, and wherever else the envelope breaks off."""
    step = interval or (float(np.median(start[1:] - end[:-1])) if len(start) > 1 else np.inf)
    breaks = np.flatnonzero(start[1:] - end[:-1] > 2.5 * step)
    seen = np.column_stack([end[breaks], start[breaks + 1]])
    gaps = gaps[np.argsort(gaps[:, 0])]
    before = np.searchsorted(gaps[:, 0], seen[:, 1]) - 1  # the last gap that begins before its end
    told = (
        (before >= 0) & (gaps[before, 1] > seen[:, 0]) if len(gaps) else np.zeros(len(seen), bool)
    )
    return [(float(a), float(b)) for a, b in np.concatenate([gaps, seen[~told]])]


def _longest(stretches: Sequence[Stretch], most: int) -> list[Stretch]:
    return sorted(stretches, key=lambda stretch: (stretch[0] - stretch[1], stretch[0]))[:most]


def _cut(log: Log) -> Log:
    """The same log with rows of the envelope cut where a missing stretch lies inside them."""
    if not log.missing:
        return log
    keep: list[int] = []
    start: list[float] = []
    end: list[float] = []
    for i, (a, b) in enumerate(zip(log.start.tolist(), log.end.tolist(), strict=True)):
        inside = [(c, d) for c, d in log.missing if c < b and d > a]
        edges = [a, *(edge for stretch in inside for edge in stretch), b]
        for left, right in zip(edges[::2], edges[1::2], strict=True):
            if left <= right:
                keep.append(i)
                start.append(left)
                end.append(right)
    return replace(log.rows(np.array(keep)), start=np.array(start), end=np.array(end))


def envelope(log: Log, channel: str, points: int) -> tuple[Array, Array, Array]:
    """Middle, smallest and largest of about `points` stretches; a nan where the log breaks off."""
    count = len(log.start)
    broken = np.zeros(count, dtype=np.int64)
    for a, b in log.missing:
        broken += log.start >= (a + b) / 2
    groups = broken * (points + 1) + np.arange(count) * min(points, count) // max(count, 1)
    first = np.flatnonzero(np.diff(groups, prepend=groups[0] - 1 if count else 0))
    last = np.append(first[1:], count) - 1
    middle = (log.start[first] + log.end[last]) / 2
    low = np.fmin.reduceat(log.least[channel], first)
    high = np.fmax.reduceat(log.most[channel], first)
    between = np.flatnonzero(np.diff(broken[first])) + 1
    return (
        np.insert(middle, between, middle[between]),
        np.insert(low, between, np.nan),
        np.insert(high, between, np.nan),
    )
