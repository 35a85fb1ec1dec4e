"""The samples around a finding, as they are drawn: places on the axis, gaps, what is masked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.tables import CHANNELS

Array = NDArray[np.float64]
Span = tuple[int, int]

LONG = 0.3  # of what is recorded: a gap that is longer is drawn as if it lasted so long
TICKS = 6


@dataclass(frozen=True)
class CloseUp:
    """n records around one finding.

    record, line, time: (n,), time s, NaN where there is none; values: (n,) of each channel;
    concerned: (n,), whether a record lies in the stretch that the finding is about.
    """

    log: str
    record: NDArray[np.int64]
    line: NDArray[np.int64]
    time: Array
    values: dict[str, Array]
    concerned: NDArray[np.bool_]

    @property
    def timed(self) -> bool:
        """Whether it can be drawn over time: every record has one, and none goes back."""
        return bool(np.isfinite(self.time).all() and (np.diff(self.time) >= 0).all())

    @property
    def x(self) -> Array:
        """Time, or the number of the line where there is none that can be drawn over."""
        return self.time if self.timed else self.line.astype(np.float64)

    def part(self, first: int, after: int) -> CloseUp:
        """Some of its records, by their places."""
        own = slice(first, after)
        values = {channel: readings[own] for channel, readings in self.values.items()}
        arrays = (self.record[own], self.line[own], self.time[own], values, self.concerned[own])
        return CloseUp(self.log, *arrays)


def close_ups(frames: Iterable[pd.DataFrame]) -> dict[str, CloseUp]:
    """The close-ups of several stages by the identifier of the finding."""
    found = {}
    for frame in frames:
        for finding, rows in frame.groupby("finding", sort=False, observed=True):
            values = {channel: rows[channel].to_numpy(dtype=np.float64) for channel in CHANNELS}
            found[str(finding)] = CloseUp(
                str(rows["log"].iloc[0]),
                rows["record"].to_numpy(dtype=np.int64),
                rows["line"].to_numpy(dtype=np.int64),
                rows["time"].to_numpy(dtype=np.float64),
                values,
                rows["concerned"].to_numpy(dtype=np.bool_),
            )
    return found


@dataclass(frozen=True)
class Axis:
    """Where records stand along the figure, when long gaps are drawn short; its ticks."""

    places: Array
    ticks: Array
    labels: tuple[str, ...]


def axis(x: Array) -> Axis:
    """Records in their distances, but for gaps that would leave no room for the samples."""
    steps = np.diff(x)
    usual = float(np.median(steps)) if len(steps) else 1.0
    gaps = steps > 2.5 * usual
    recorded = float(steps[~gaps].sum()) or 1.0
    longest = np.where(gaps, LONG * recorded, np.inf)
    drawn = np.minimum(steps, longest)
    places = np.concatenate([[0.0], np.cumsum(drawn)]) + (x[0] if len(x) else 0.0)
    cuts = np.flatnonzero(steps > longest) + 1
    ticks: list[float] = []
    at: list[float] = []
    stretches = [own for own in np.split(np.arange(len(x)), cuts) if len(own) > 1]
    for own in stretches:
        wanted = max(TICKS // len(stretches), 2)
        nice = MaxNLocator(wanted).tick_values(x[own[0]], x[own[-1]])
        inside = nice[(nice >= x[own[0]]) & (nice <= x[own[-1]])]
        ticks += inside.tolist()
        at += np.interp(inside, x[own], places[own]).tolist()
    return Axis(places, np.array(at), _written(ticks))


def _written(ticks: Sequence[float]) -> tuple[str, ...]:
    """With as many decimals as tell them apart."""
    for decimals in range(5):
        texts = [f"{tick:.{decimals}f}" for tick in ticks]
        if all(abs(float(text) - tick) < 1e-6 for text, tick in zip(texts, ticks, strict=True)):
            break
    return tuple(text.replace("-", "−") for text in texts) if ticks else ()


def gaps_in(close_up: CloseUp, gaps: pd.DataFrame) -> list[int]:
    """The places of the records that follow a gap."""
    own = gaps["record"][(gaps["log"] == close_up.log).to_numpy()].to_numpy(dtype=np.int64)
    after = np.searchsorted(close_up.record, own)
    there = (after > 0) & (after < len(close_up.record))
    return sorted(
        int(i)
        for i, record in zip(after[there], own[there], strict=True)
        if close_up.record[i] == record
    )


def masked_in(close_up: CloseUp, masks: pd.DataFrame, channels: Sequence[str]) -> list[Span]:
    """Stretches that are masked, of all channels or of one of these: first and last place."""
    record = close_up.record
    concerned = masks["channel"].isna() | masks["channel"].isin(channels)
    near = (masks["to_record"] > record[0]) & (masks["from_record"] <= record[-1])
    own = masks[(masks["log"] == close_up.log) & concerned & near]
    hidden = np.zeros(len(record) + 2, dtype=np.int64)
    for row in own.itertuples():
        first, after = np.searchsorted(record, [row.from_record, row.to_record])
        hidden[first + 1 : after + 1] = 1
    edges = np.diff(hidden)
    both = zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True)
    return [(int(first), int(after) - 1) for first, after in both]
