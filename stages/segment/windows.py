"""The parts of a log in which manoeuvres are sought, and short means of them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.campaign.masked_samples import Batch, Masks, regular
from inertial.campaign.records import Clock, Manoeuvre
from inertial.campaign.sums import MeansOver
from inertial.signal.rests_and_motions import MAX_KNOCK_TILT, bridged
from inertial.signal.runs import runs

BIN_S = 0.1  # s, of the short means in which motion is sought
MAX_BRIDGED_S = 30.0  # s, masked of one gyro alone: in a turn that goes on on both sides it is less
MIN_PAUSE_S = 1.0  # s without a record, in which an IMU may be set anew
MAX_BINS = 2_000_000  # of them in a campaign; one of more than two days has longer ones
MIN_BINS_OF_A_JUMP = 7  # three before it, three after it, and one that may hold readings of both


@dataclass(frozen=True)
class Window:
    """Records [first, after) of a log, in which manoeuvres are sought in the plan's order."""

    log: str
    first: int
    after: int
    manoeuvres: Sequence[Manoeuvre]

    @property
    def alone(self) -> bool:
        """Whether a single manoeuvre has the window for itself."""
        return len(self.manoeuvres) == 1


def rate_about(axis: Array, rates: Array) -> Array:
    """The rate about an axis, (k,), of rates (k, 3); NaN where no gyro is recorded."""
    recorded = np.isfinite(rates).any(axis=1)
    return np.where(recorded, np.nan_to_num(rates) @ axis, np.nan)


@dataclass(frozen=True)
class Binned:
    """A window in k bins of equal length.

    `edges`: (k + 1,), records; `rates`, `forces`: (k, 3), rad/s and m/s², NaN where not
    recorded; where a gyro is masked its rate is on a straight line; `seconds`: (k,), what the
    means are sums over; `first_s`, `last_s`: (k,); `censored`: (k, 6), where a channel is cut off
    at the end of its range, None where none is; `quantum`: (6,), step of each channel, NaN where it
    is not known; `unread`: (k, 6), where a channel has no reading, None where it is not known.
    """

    window: Window
    edges: Integers
    rates: Array
    forces: Array
    seconds: Array
    first_s: Array
    last_s: Array
    censored: Booleans | None = None
    quantum: Array = field(default_factory=lambda: np.full(6, np.nan))
    unread: Booleans | None = None

    @property
    def read_rates(self) -> Array:
        """The rates, (k, 3), NaN where a gyro is masked too: what is measured, not sought in."""
        if self.unread is None:
            return self.rates
        return np.where(self.unread[:, 3:], np.nan, self.rates)

    @property
    def bins(self) -> int:
        """How many."""
        return len(self.seconds)

    @property
    def bin_seconds(self) -> float:
        """The length of a bin that is not masked, s."""
        there = self.seconds[self.seconds > 0]
        return float(np.median(there)) if len(there) else BIN_S

    @property
    def beside_pauses(self) -> Booleans:
        """The bins in which the recording pauses, or beside a pause between two, (k,)."""
        beside = np.zeros(self.bins, bool)
        between, within = self.first_s[1:] - self.last_s[:-1], self.last_s - self.first_s
        for shift, lasting in ((1, between), (0, within)):
            known = lasting[np.isfinite(lasting)]
            usual = float(np.median(known)) if len(known) else 0.0
            pauses = np.flatnonzero(lasting > MIN_PAUSE_S + 2 * usual)
            beside[pauses] = beside[pauses + shift] = True
        return beside

    @property
    def beside_jumps(self) -> Booleans:
        """The bins across which gravity jumps to another direction, as no rest does, (k,).

        So it does where rests were joined without what lay between them.
        """
        beside = np.zeros(self.bins, bool)
        if self.bins < MIN_BINS_OF_A_JUMP:
            return beside
        means = np.stack([self.forces[i : self.bins - 2 + i] for i in range(3)]).mean(axis=0)
        # Of three bins each and of one, with one between them; not where they are not recorded.
        lasting = _has_turned(means[:-4], means[4:])
        beside[3:-3] = lasting & _has_turned(self.forces[2:-4], self.forces[4:-2])
        return beside

    def bins_in(self, seconds: float) -> int:
        """How many bins some time is; where it is any, at least one, however long a bin is."""
        return max(round(seconds / self.bin_seconds), int(seconds > 0))

    def about(self, axis: Array, level: Array) -> Array:
        """Rate about an axis, (k,), rad/s; `level` is what the gyros read at rest."""
        return rate_about(axis, self.rates - level)

    def cuts_off(self, axis: Array, first: int, after: int) -> bool:
        """Whether a gyro that measures the rate about an axis is cut off in bins [first, after)."""
        if self.censored is None:
            return False
        return bool((self.censored[first:after, 3:].any(axis=0) & (axis != 0)).any())

    def duration(self, first: int, after: int) -> float:
        """From the first record of the bins [first, after) to the last, s; 0 without time."""
        return float(np.nan_to_num(self.last_s[after - 1] - self.first_s[first]))


def _has_turned(before: Array, after: Array) -> Booleans:
    """Whether directions (k, 3) differ by more than a knock leaves, (k,)."""
    size = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    return np.asarray(np.sum(before * after, axis=1) < np.cos(MAX_KNOCK_TILT) * size)


class Selection:
    """For each manoeuvre the records that its span, rows or label select."""

    columns = ("time", "label")

    def __init__(self, manoeuvres: Sequence[Manoeuvre]) -> None:
        self.manoeuvres = [m for m in manoeuvres if m.selected]
        self.records: dict[str, tuple[int, int]] = {}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        for m in self.manoeuvres:
            if m.log != batch.log:
                continue
            if m.from_row is not None:
                inside = (batch["record"] >= m.from_row) & (batch["record"] < m.to_row)
            elif m.from_s is not None:
                inside = (batch["time"] >= m.from_s) & (batch["time"] < m.to_s)
            else:
                inside = batch["label"] == m.label
            records = batch["record"][inside]
            if len(records):
                first, _ = self.records.get(m.name, (int(records[0]), 0))
                self.records[m.name] = (first, int(records[-1]) + 1)


def windows(
    manoeuvres: Sequence[Manoeuvre], ends: Mapping[str, int], selection: Selection
) -> list[Window]:
    """A window for each manoeuvre that the plan selects, and one for all others of a log."""
    made = []
    for log in dict.fromkeys(m.log for m in manoeuvres if not m.selected):
        others = [m for m in manoeuvres if m.log == log and not m.selected]
        made.append(Window(log, 0, ends.get(log, 0), others))
    for m in selection.manoeuvres:
        made.append(Window(m.log, *selection.records.get(m.name, (0, 0)), [m]))
    return sorted(made, key=lambda window: (window.log, window.first))


class Bins:
    """Every window in bins; they may overlap, as where the plan selects parts of a log.

    Windows of one layer do not, for means are over stretches that ascend.
    """

    columns = MeansOver.columns

    def __init__(
        self,
        windows: Sequence[Window],
        clocks: Mapping[str, Clock],
        masks: Masks,
        quanta: Mapping[str, Array] | None = None,
    ) -> None:
        records = sum(window.after - window.first for window in windows)
        self._edges: list[tuple[Integers, Integers]] = []
        self._layer: list[int] = []
        layers: list[dict[str, list[tuple[Integers, Integers]]]] = []
        reached: list[dict[str, int]] = []
        for window in windows:
            bin_records = round(BIN_S / clocks[window.log].step) if window.log in clocks else 1
            length = max(1, bin_records, -(-records // MAX_BINS))
            first, after = regular(window.after - window.first, length)
            self._edges.append((window.first + first, window.first + after))
            free = [n for n, r in enumerate(reached) if r.get(window.log, 0) <= window.first]
            number = free[0] if free else len(layers)
            if not free:
                layers.append({})
                reached.append({})
            self._layer.append(number)
            layers[number].setdefault(window.log, []).append(self._edges[-1])
            reached[number][window.log] = window.after
        self._means = [
            MeansOver(
                {
                    log: (np.concatenate([f for f, _ in own]), np.concatenate([a for _, a in own]))
                    for log, own in layer.items()
                },
                masks,
            )
            for layer in layers
        ]
        self._windows = windows
        self._clocks = clocks
        self._censoring = masks
        self._quanta = quanta or {}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        for means in self._means:
            means.add(batch)

    def binned(self) -> Iterator[Binned]:
        """The windows, once every batch was added."""
        results = [means.result() for means in self._means]
        used = [dict.fromkeys(means, 0) for means in results]
        each = zip(self._windows, self._edges, self._layer, strict=True)
        for window, (first, after), number in each:
            begin = used[number][window.log]
            part = slice(begin, begin + len(first))
            used[number][window.log] += len(first)
            edges = np.append(first, after[-1:])
            own = results[number][window.log]
            cut_off = self._censoring.censored_between(window.log, edges) if len(first) else None
            long = round(MAX_BRIDGED_S / BIN_S) if window.log in self._clocks else len(first)
            yield Binned(
                window,
                edges,
                _sought_in(own.mean[part, 3:], long, cut_off),
                own.mean[part, :3],
                own.count[part] * self._clocks[window.log].step if len(first) else np.array([]),
                own.first[part],
                own.last[part],
                cut_off,
                self._quanta.get(window.log, np.full(6, np.nan)),
                ~np.isfinite(own.mean[part]),
            )


def _sought_in(rates: Array, long: int, cut_off: Booleans | None) -> Array:
    """The rates in which motion is sought, (k, 3), from means, NaN where masked.

    A turn stays one where a stretch is masked; no angle is made of these rates. A gyro that is
    masked alone for more bins than `long`, and not cut off, shows no motion there: those beside it
    may have been within a turn.
    """
    filled = bridged(rates)
    there = np.isfinite(rates)
    for i in range(3):
        if not there[:, i].any():
            continue
        for first, after in runs(~there[:, i]):
            alone = there[first:after].any()
            held = cut_off is not None and cut_off[first:after, 3 + i].any()
            if after - first > long and alone and not held:
                filled[first:after, i] = np.median(rates[there[:, i], i])
    return filled
