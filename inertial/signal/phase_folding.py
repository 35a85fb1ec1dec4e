"""Readings that are off at one phase of a period, found by folding their stamps."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, ndtr, ndtri

from inertial.arrays import Array, Booleans, Integers
from inertial.sensors import CHANNELS, COLUMNS
from inertial.signal.runs import new_readings, records_of_a_reading
from inertial.signal.scatter import MAD_TO_SIGMA, MIN_RELATIVE_STEP, median

PERIODS = (60.0, 30.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5, 0.2, 0.1)  # s, each divides the first
FINEST = 600  # phases of 0.1 s in the longest
MAX_PHASE_MISFIT = 0.02  # of an interval: how far that may be from a whole fraction of 0.1 s
MIN_INTERVAL = 1e-4  # s: the number of phases bounds the memory
MIN_PERIOD_SAMPLES = 10  # of which a single one can stand out
WIDTHS = (1, 2)  # phases that are judged together: an instant may lie at the border of two
SIDE = 2  # readings on either side that a reading is compared with
BLOCK = 256  # readings of which the scatter is taken
MIN_BLOCK = 16
MAX_OFF_SIGMA = 3.0  # what is farther off counts no more, so that no single reading decides
MAX_SLOPE_SIGMA = 4.0  # from the readings before to those after: more is a ramp or a motion
BEND_READINGS, MAX_BEND_SIGMA = 24, 4.0  # of those so far before and after, against those between
MIN_LEVEL_SIGMA = 10.0  # of a reading of which a share can be off: less is in part its own noise
MAX_INTERVALS = 1.5  # intervals between neighbours
MAX_RECORDS_MISFIT = 0.1  # how far the records of a reading may be above a whole number
MIN_OCCURRENCES = 4.0  # records at the phase
FALSE_ALARM_LEVEL = 1e-4  # for all phases, periods and channels of a campaign
COMPARABLE_SHARE = 0.5  # of its significance, by which other phases are off as well
MIN_COMPARABLE_SIGMA = 3.0
MAX_COMPARABLE = 0.1  # of the phases of a period; where more are, it oscillates
SCATTER_LEVEL = 0.05  # of the phases of a period: where they scatter by more, that is its noise
LIKELIER = 9.0  # chi-squared by which a period must be better, for another to be excluded
NOT_HELD = np.zeros(2)  # share of the records that repeat a reading, by sensor
# What may be off: a channel by a constant, or all of a sensor by a share of what they read.
SIGNATURES: tuple[tuple[str, int | None], ...] = (
    *((channel.partition("_")[0], i) for i, channel in enumerate(CHANNELS)),
    *((sensor, None) for sensor in COLUMNS),
)


@dataclass(frozen=True)
class Glitch:
    """What is off at one phase of a period.

    channel: that reads `size` more, m/s² or rad/s; where it is None all of `sensor` read
    (1 + size) times what they should. period: s, the longest that fits; others: s, which fit
    as well. phase, width: s, of stamps modulo the period, where the records are. p_value: the
    search paid for. places: how many phases the longest period is divided into; origin: s, added to
    the stamps.
    """

    sensor: str
    channel: int | None
    period: float
    others: tuple[float, ...]
    phase: float
    width: float
    size: float
    p_value: float
    places: int
    origin: float

    def falls_on(self, time: Array) -> Booleans:
        """Which stamps, (n,), s, have this phase."""
        step = PERIODS[0] / self.places
        away = phases(time + self.origin, self.places) - round(self.phase / step)
        inside = np.mod(away, round(self.period / step)) < round(self.width / step)
        return np.asarray(inside & np.isfinite(time))


def places_of(interval: float) -> int:
    """Into how many phases the longest period is divided, none longer than the interval, s.

    None where that is so short, or so long, that no period can be examined.
    """
    if not MIN_INTERVAL <= interval <= PERIODS[0] / MIN_PERIOD_SAMPLES:
        return 0
    each = PERIODS[0] / interval / FINEST
    return FINEST * max(int(np.ceil(each - MAX_PHASE_MISFIT)), 1)


def phases(time: Array, places: int) -> Integers:
    """The phase of each stamp, (n,), s, in the longest period: 0 … places − 1."""
    share = np.mod(np.nan_to_num(time), PERIODS[0]) / PERIODS[0]
    return np.rint(share * places).astype(np.int64) % places


class Folded:
    """Sums over the records of one clock, by the phase of their stamps.

    A reading is compared with the mean of the middle two of the four beside it, in which neither a
    single wrong one nor a ramp leaves a trace. It is off by y sigma, of which no more than 3
    count. By a share of 1 it would be off by s = reading/σ: there y has the sign and the weight
    √|s|, so that it is not a few quiet records alone that decide, and the three channels of a
    record are one observation.
    """

    def __init__(self, interval: float, origin: float = 0.0) -> None:
        self.interval, self.places, self.origin = interval, places_of(interval), origin
        # Of each signature and phase: Σ w·y of what counts, Σ w², Σ w⁴, and the fraction by which
        # what is off is estimated from all of y.
        self.sums = np.zeros((5, len(SIGNATURES), self.places))
        # Σ (w·y)² of what counts, Σ w², and the sum of the products of neighbours.
        self.squares = np.zeros((3, len(SIGNATURES)))

    def add(self, time: Array, values: Array, held: Array = NOT_HELD) -> None:
        """Consecutive records: stamps, (n,), s, NaN where there is none; readings, (n, 6).

        held : share of the records in which the accelerometers, or the gyros, repeat a reading;
            there only new ones are compared, for those held make steps of any motion
        """
        for number, own in enumerate(COLUMNS.values()):
            readings, interval = values[:, own], self.interval
            if held[number]:
                new = new_readings(readings)
                interval *= float(np.ceil(records_of_a_reading(held[number]) - MAX_RECORDS_MISFIT))
                self._add(number, time[new], readings[new], interval)
            else:
                self._add(number, time, readings, interval)

    def _add(self, number: int, time: Array, readings: Array, interval: float) -> None:
        """The readings, (n, 3), of the accelerometers, 0, or the gyros, 1."""
        if len(time) < MIN_BLOCK or not self.places:
            return
        off, level, sigma = _compared(np.ascontiguousarray(readings.T))
        near = np.abs(np.diff(time)) < MAX_INTERVALS * interval
        beside = np.all(np.lib.stride_tricks.sliding_window_view(near, 2 * SIDE), axis=1)
        known = beside & np.isfinite(off) & (sigma > 0)
        off[~known], sigma[~known] = 0.0, np.inf
        y = off / sigma
        phase = phases(time[SIDE:-SIDE] + self.origin, self.places)
        for i in range(3):
            there = known[i].astype(np.float64)
            counted = np.clip(y[i], -MAX_OFF_SIGMA, MAX_OFF_SIGMA)
            self._take(3 * number + i, phase, counted, there, there, off[i], there)
        s = np.where(known, level, 0.0) / sigma
        s[np.abs(s) < MIN_LEVEL_SIGMA] = 0.0
        square, w2 = s**2, np.sum(np.abs(s), axis=0)
        most = MAX_OFF_SIGMA * np.sqrt(w2)
        along = np.sum(np.copysign(np.sqrt(np.abs(s)), s) * y, axis=0)
        fraction = np.sum(s * y, axis=0), np.sum(square, axis=0)
        counted = np.clip(along, -most, most)
        self._take(len(CHANNELS) + number, phase, counted, w2, w2**2, *fraction)

    def _take(self, number: int, phase: Integers, counted: Array, w2: Array, *more: Array) -> None:
        self.squares[:, number] += counted @ counted, w2.sum(), counted[:-1] @ counted[1:]
        for k, column in enumerate((counted, w2, *more)):
            self.sums[k, number] += np.bincount(phase, column, self.places)


def _compared(values: Array) -> tuple[Array, Array, Array]:
    """By how much each reading but the outer ones is off, what those beside it read, and σ, (6, n).

    σ is the scatter of the first around, 0 where it is not known, or the readings go up or down, or
    bend: at the peak of a motion each is off by less than the noise, but at each repetition alike.
    """
    n = values.shape[1] - 2 * SIDE
    a, b, c, d = (values[:, k : k + n] for k in (0, 1, 3, 4))
    most = np.maximum(np.maximum(a, b), np.maximum(c, d))
    least = np.minimum(np.minimum(a, b), np.minimum(c, d))
    level = (a + b + c + d - most - least) / 2
    off = values[:, SIDE:-SIDE] - level
    # Of equal readings the mean of two differs from the third in its last digits.
    off[np.abs(off) <= MIN_RELATIVE_STEP * np.maximum(np.abs(most), np.abs(least))] = 0.0
    number, length = max(n // BLOCK, 1), min(BLOCK, n)
    blocks = np.nan_to_num(np.abs(off[:, : number * length])).reshape(len(values), number, length)
    scatter = MAD_TO_SIGMA * median(blocks)
    sigma = scatter[:, np.minimum(np.arange(n) // length, number - 1)]
    steep = np.abs(c + d - a - b) / 2 > MAX_SLOPE_SIGMA * sigma
    bent = np.abs(_second_difference(level)) > MAX_BEND_SIGMA * sigma
    sigma[steep | bent] = 0.0
    return off, level, sigma


def _second_difference(values: Array) -> Array:
    """Of (k, n), by `BEND_READINGS`; the outermost have themselves in place of those beyond."""
    step = BEND_READINGS
    padded = np.pad(values, ((0, 0), (step, step)), mode="edge")
    return np.asarray(padded[:, : -2 * step] + padded[:, 2 * step :] - 2 * values)


@dataclass(frozen=True, eq=False)
class _Scan:
    """All phases of one period, (k, signatures): by how many sigma they are off, and how far."""

    period: float
    width: int
    sigmas: Array
    size: Array
    occurrences: Array

    @property
    def tried(self) -> Booleans:
        return np.asarray(self.occurrences >= MIN_OCCURRENCES)


def glitches(clocks: Mapping[str, Folded]) -> dict[str, tuple[Glitch, ...]]:
    """What is off at one phase of a period, by the name of the clock."""
    scans = {name: list(_scans(folded)) for name, folded in clocks.items() if folded.places}
    tests = sum(int(np.count_nonzero(scan.tried)) for own in scans.values() for scan in own)
    return {name: tuple(_of_clock(clocks[name], own, max(tests, 1))) for name, own in scans.items()}


def _scans(folded: Folded) -> Iterator[_Scan]:
    squares, weights, products = folded.squares
    for period in PERIODS:
        if period / folded.interval < MIN_PERIOD_SAMPLES:
            continue
        turns = round(PERIODS[0] / period)
        sums = folded.sums.reshape(5, len(SIGNATURES), turns, -1).sum(axis=2)
        for width in WIDTHS:
            together = np.sum([np.roll(sums, -shift, axis=2) for shift in range(width)], axis=0)
            counted, w2, w4, above, below = np.swapaxes(together, 1, 2)
            # Where readings scatter more than by their median they are less sure, and two together
            # where a filter makes neighbours alike.
            pairs = (width - 1) * np.fmax(products, 0.0)
            spread = (squares + pairs) / np.where(weights > 0, weights, 1.0)
            excess = np.sqrt(np.fmax(spread, 1.0))
            with np.errstate(invalid="ignore", divide="ignore"):
                yield _Scan(
                    period,
                    width,
                    np.nan_to_num(counted / np.sqrt(w2)) / excess,
                    np.nan_to_num(above / below),
                    np.nan_to_num(w2**2 / w4),
                )


def _of_clock(folded: Folded, scans: list[_Scan], tests: int) -> Iterator[Glitch]:
    if not scans:
        return
    least = float(-ndtri(FALSE_ALARM_LEVEL / tests / 2))
    best = [_best(scans, signature) for signature in range(len(SIGNATURES))]
    for number, (sensor, channel) in enumerate(SIGNATURES):
        sigmas, scan, phase = best[number]
        rivals = [
            best[other][0]
            for other, (of, one) in enumerate(SIGNATURES)
            if of == sensor and (one is None) != (channel is None)
        ]
        if sigmas < least or sigmas < max(rivals) or not _stands_alone(scan, number, phase, least):
            continue
        step = PERIODS[0] / folded.places
        for peak in _peaks(scan, number, least):
            fitting = sorted(_fitting(scans, scan, number, peak), key=lambda one: -one[0].period)
            (longest, k), others = fitting[0], fitting[1:]
            yield Glitch(
                sensor,
                channel,
                longest.period,
                tuple(other.period for other, _ in others),
                k * step,
                scan.width * step,
                float(longest.size[k, number]),
                float(min(2 * ndtr(-abs(scan.sigmas[peak, number])) * tests, 1.0)),
                folded.places,
                folded.origin,
            )


def _best(scans: list[_Scan], number: int) -> tuple[float, _Scan, int]:
    """The phase that is off most clearly."""
    found = []
    for scan in scans:
        sigmas = np.where(scan.tried[:, number], np.abs(scan.sigmas[:, number]), 0.0)
        found.append((float(sigmas.max()), scan, int(np.argmax(sigmas))))
    return max(found, key=lambda each: each[0])


def _apart(number: int, k: int, width: int) -> Booleans:
    """Which of so many phases are compared with none of phase k, (number,)."""
    away = np.mod(np.arange(number) - k, number)
    return np.asarray(np.minimum(away, number - away) > SIDE + width - 1)


def _stands_alone(scan: _Scan, number: int, k: int, least: float) -> bool:
    """Whether other phases are not off as well, as those of an oscillation are.

    Few are as far off; and where all scatter by more than chance, it stands out of their scatter
    as it should of noise: of an oscillation as weak as the noise one phase is the highest.
    """
    sigmas = np.abs(scan.sigmas[:, number])
    off = sigmas[scan.tried[:, number] & _apart(len(sigmas), k, scan.width)]
    comparable = off > max(COMPARABLE_SHARE * sigmas[k], MIN_COMPARABLE_SIGMA)
    if np.count_nonzero(comparable) > MAX_COMPARABLE * len(off):
        return False
    by_chance = len(off) == 0 or chdtrc(len(off), off @ off) > SCATTER_LEVEL
    return bool(by_chance or sigmas[k] >= least * MAD_TO_SIGMA * median(off))


def _peaks(scan: _Scan, number: int, least: float) -> Iterator[int]:
    """The phases that are off, each further off than those beside it."""
    left = np.where(scan.tried[:, number], np.abs(scan.sigmas[:, number]), 0.0)
    while left.max() >= least:
        k = int(np.argmax(left))
        yield k
        left = left * _apart(len(left), k, scan.width)


def _fitting(scans: list[_Scan], best: _Scan, number: int, k: int) -> Iterator[tuple[_Scan, int]]:
    """The periods by which the records of phase k of the best are as far off, with their phase."""
    chi2 = best.sigmas[k, number] ** 2
    for scan in scans:
        if scan.width == best.width:
            n, of_best = len(scan.sigmas), len(best.sigmas)
            own = np.unique(np.arange(k, max(n, of_best), of_best) % n)
            sigmas = np.where(scan.tried[own, number], np.abs(scan.sigmas[own, number]), 0.0)
            if chi2 - sigmas.max() ** 2 < LIKELIER:
                yield scan, int(own[np.argmax(sigmas)])
