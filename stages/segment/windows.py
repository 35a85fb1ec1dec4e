"""The parts of a log in which manoeuvres are looked for, and short means of them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.masked_samples import Integers, Masks, pieces, regular
from inertial.campaign.records import Clock, Manoeuvre
from inertial.campaign.sums import means_over
from inertial.tables.parquet import Stream

Array = NDArray[np.float64]

BIN = 0.1  # s, of the short means in which motion is looked for
MOST = 2_000_000  # of them in a campaign; one of more than two days has longer ones


@dataclass(frozen=True)
class Window:
    """Records [first, after) of a log, in which manoeuvres are looked for in the plan's order."""

    log: str
    first: int
    after: int
    manoeuvres: Sequence[Manoeuvre]

    @property
    def alone(self) -> bool:
        """Whether a single manoeuvre has the window for itself."""
        return len(self.manoeuvres) == 1


@dataclass(frozen=True)
class Binned:
    """A window in k bins of equal length.

    `edges`: (k + 1,), records; `rates`, `forces`: (k, 3), rad/s and m/s², NaN where not
    recorded; where a gyro is masked its rate is on a straight line; `seconds`: (k,), what the
    means are sums over; `first_s`, `last_s`: (k,).
    """

    window: Window
    edges: Integers
    rates: Array
    forces: Array
    seconds: Array
    first_s: Array
    last_s: Array

    @property
    def bins(self) -> int:
        """How many."""
        return len(self.seconds)

    @property
    def bin_seconds(self) -> float:
        """The length of a bin that is not masked, s."""
        there = self.seconds[self.seconds > 0]
        return float(np.median(there)) if len(there) else BIN

    def bins_in(self, seconds: float) -> int:
        """How many bins some time is; where it is any, at least one, however long a bin is."""
        return max(round(seconds / self.bin_seconds), int(seconds > 0))

    def about(self, axis: Array, level: Array) -> Array:
        """Rate about an axis, (k,), rad/s; `level` is what the gyros read at rest."""
        rates = self.rates - level
        recorded = np.isfinite(rates).any(axis=1)
        return np.where(recorded, np.nan_to_num(rates) @ axis, np.nan)

    def duration(self, first: int, after: int) -> float:
        """From the first record of the bins [first, after) to the last, s; 0 without time."""
        return float(np.nan_to_num(self.last_s[after - 1] - self.first_s[first]))


def windows(
    samples: Stream, manoeuvres: Sequence[Manoeuvre], ends: Mapping[str, int]
) -> list[Window]:
    """A window for each manoeuvre that the plan selects, and one for all others of a log."""
    found = []
    for log in dict.fromkeys(m.log for m in manoeuvres if not m.selected):
        others = [m for m in manoeuvres if m.log == log and not m.selected]
        found.append(Window(log, 0, ends.get(log, 0), others))
    selected = [m for m in manoeuvres if m.selected]
    spans = _selected(samples, selected) if selected else {}
    found += [Window(m.log, *spans.get(m.name, (0, 0)), [m]) for m in selected]
    return sorted(found, key=lambda window: (window.log, window.first))


def _selected(samples: Stream, manoeuvres: Sequence[Manoeuvre]) -> dict[str, tuple[int, int]]:
    """For each manoeuvre the records that its span, rows or label select."""
    found: dict[str, tuple[int, int]] = {}
    for log, piece in pieces(samples, ["record", "time", "label"]):
        for m in manoeuvres:
            if m.log != log:
                continue
            if m.from_row is not None:
                inside = (piece["record"] >= m.from_row) & (piece["record"] < m.to_row)
            elif m.from_s is not None:
                inside = (piece["time"] >= m.from_s) & (piece["time"] < m.to_s)
            else:
                inside = piece["label"] == m.label
            records = piece["record"][inside]
            if len(records):
                first, _ = found.get(m.name, (int(records[0]), 0))
                found[m.name] = (first, int(records[-1]) + 1)
    return found


def binned(
    samples: Stream, found: Sequence[Window], clocks: Mapping[str, Clock], masks: Masks
) -> Iterator[Binned]:
    """Every window in bins, all in one pass over the samples; windows ascend within a log."""
    cut: dict[str, list[tuple[Integers, Integers]]] = {}
    shortest = -(-sum(window.after - window.first for window in found) // MOST)
    for window in found:
        short = round(BIN / clocks[window.log].step) if window.log in clocks else 1
        length = max(1, short, shortest)
        first, after = regular(window.after - window.first, length)
        cut.setdefault(window.log, []).append((window.first + first, window.first + after))
    stretches = {
        log: (np.concatenate([f for f, _ in cuts]), np.concatenate([a for _, a in cuts]))
        for log, cuts in cut.items()
    }
    means = means_over(samples, stretches, masks)
    used = dict.fromkeys(cut, 0)
    for window in found:
        first, after = cut[window.log].pop(0)
        part = slice(used[window.log], used[window.log] + len(first))
        used[window.log] += len(first)
        total = means[window.log]
        yield Binned(
            window,
            np.append(first, after[-1:]),
            _straight(total.mean[part, 3:]),
            total.mean[part, :3],
            total.count[part] * clocks[window.log].step if len(first) else np.array([]),
            total.first[part],
            total.last[part],
        )


def _straight(rates: Array) -> Array:
    """The rates of bins, (k, 3), and straight lines over the bins in which a gyro is masked.

    So a turn stays one where a stretch of it is masked; no angle is made of these rates.
    """
    place, filled = np.arange(len(rates)), rates.copy()
    for i, there in enumerate(np.isfinite(rates).T):
        if there.any():
            filled[:, i] = np.interp(place, place[there], rates[there, i])
    return filled
