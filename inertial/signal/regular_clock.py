"""The regular clock of samples whose stamps are given late, in bursts, or coarsely.

A host stamps a sample when it arrives. Packets of USB or Bluetooth bring many samples at once, and
a busy host lets them wait, so stamps are late by D_k ≥ 0 and

    stamp_k = a + T n_k + D_k,    n_k the number of the sample, with those that are missing.

A delay passes: the samples that waited come in quick succession. What stays is a gap. So the least
of stamp − T k over a second on one side of a sample, less that on the other side, is T times the
number of samples missing there. The line through these least values is the clock. What they scatter
about it by is what its slope is uncertain by: two of one busy spell of the host are not two, and
stamps in steps of q do not show a slope that changes them by less than q.

Where a link loses a sample in every second or so, no second tells its neighbour from itself. Stamps
that scatter by less than a third of an interval count the samples by themselves, then: by the phase
of an interval at which they lie, which moves slowly.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter, minimum_filter1d

from inertial.arrays import Array, Integers
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.signal.stamps import unit_of

# Share of an interval by which stamps may scatter. Above it single steps come near one and a half
# intervals, by which a missing sample is recognised, and their median is no interval any more.
MAX_SCATTER = 0.05
MAX_FAULTY_SHARE = 0.02  # of the steps: so few that are off are faults of their own
MAX_STEP_RATIO = 1.5  # of the interval by the slope to the median step: more is no loss of samples
MAX_DELAY_S = 1.0  # s: a host that is busy for longer has lost samples
MIN_WINDOW = 8  # samples in which some arrive without delay
MIN_SHIFT = 0.75  # intervals: what is nearer to one missing sample than to none
MIN_SHIFT_SIGMA = 6.0
MAX_APART = 4  # windows: one gap in eight lies within half of the distances
REFINEMENTS = 3  # of the interval by the samples that arrive without delay
MIN_WINDOWS = 4  # through whose least values a line is laid
PHASE_SAMPLES = 200  # whose stamps show the phase: by then the interval is off by a tenth at most
PHASE_NEIGHBOURS = 7  # stamps, of which most are nearest to their own number
PHASE_PIECES = 50  # of so many samples, by which the interval is found
PHASE_TRIALS = np.linspace(-0.03, 0.03, 121)  # relative, from the mean of the usual steps
MAX_LOST_SHARE = 0.2  # of the samples: packets of samples in quick succession are no loss
MAX_PHASE_SCATTER = 0.3  # intervals, of stamps that count the samples by themselves
MIN_IMPROVEMENT = 3.0  # of the scatter, by such a count
TINY = float(np.finfo(float).tiny)


@dataclass(frozen=True)
class RegularClock:
    """The clock of n samples.

    start: s, of the sample with number 0, on the scale of the stamps; interval, interval_sigma: s;
    number: (n,), by which a gap is as many as are missing; scatter: s, rms of the stamps about the
    clock; shortest_gap: s, that such stamps show.
    """

    start: float
    interval: float
    interval_sigma: float
    number: Integers
    scatter: float
    shortest_gap: float

    @property
    def time(self) -> Array:
        """The times of the samples since the first one, (n,), s."""
        return np.asarray(self.interval * (self.number - self.number[0]))


def are_regular(time: Array) -> bool:
    """Whether stamps, (n,), s, lie at one interval from each other, or at multiples of it.

    Those that do not advance at all are no clock, regular or not.
    """
    step = np.diff(time)
    if len(step) < MIN_WINDOW or _slope(time, len(step) // 4) <= 0:
        return True
    usual = float(np.median(step))
    if usual <= 0:
        return False
    short = np.cumsum(np.minimum(step, max(MAX_DELAY_S, usual)))  # a pause is no delay
    slope = _slope(short, len(short) // 4)
    off = step / usual - np.maximum(np.rint(step / usual), 1)
    square = np.sort(np.clip(off, -1, 1) ** 2)[: round(len(off) * (1 - MAX_FAULTY_SHARE))]
    return bool(np.sqrt(square.mean() / 2) < MAX_SCATTER and slope < MAX_STEP_RATIO * usual)


def regular_clock(time: Array) -> RegularClock | None:
    """The clock of samples with these stamps, (n,), s, which are not regular.

    None where they do not advance.
    """
    count = len(time)
    even = _evened(time)
    if (interval := _slope(even, count // 4)) <= 0:
        return None
    window = int(np.clip(MAX_DELAY_S / interval, MIN_WINDOW, max(count // MIN_WINDOWS, 1)))
    interval = _between_least(even, max(_slope(even, window), 0.0) or interval, window)
    missing = _set_back(even, interval, window)
    delay = even - interval * _numbers(missing)
    # Where stamps stand still a sample that comes before the next one or after it is none lost.
    shortest = _shortest_gap(delay, interval, window) + interval * bool((even != time).any())
    number = _numbers(missing + _gaps(delay, interval, window, shortest))
    found = _through(time, even, number, interval, window, shortest)
    by_phase = _numbers_by_phase(time)
    if by_phase is not None:
        numbers, interval = by_phase
        other = _through(time, even, numbers, interval, window, MIN_SHIFT * interval)
        little = other.scatter < MAX_PHASE_SCATTER * other.interval
        if little and MIN_IMPROVEMENT * other.scatter < found.scatter:
            return other
    return found


def _through(
    time: Array, even: Array, number: Integers, interval: float, window: int, shortest: float
) -> RegularClock:
    """The clock of samples of these numbers, (n,), at about this interval."""
    least = _least(even - interval * number, window)
    if len(least) < MIN_WINDOWS:
        least = np.arange(len(time))
    slope, start = np.polyfit(number[least], even[least], 1).tolist()
    left = np.clip(time - start - slope * number, -MAX_DELAY_S, MAX_DELAY_S)
    coarse = _longest_step(slope * np.arange(window), unit_of(np.diff(time)))
    sigma = _slope_sigma(number[least], even[least] - start - slope * number[least], coarse)
    return RegularClock(start, slope, sigma, number, float(left.std()), shortest)


def _evened(time: Array) -> Array:
    """Stamps that stand still, laid evenly from the first of them, no faster than most, (n,)."""
    moves = np.append(True, np.diff(time) != 0)
    changes = np.flatnonzero(moves)
    if len(changes) in (1, len(time)):
        return time
    slope = np.diff(time[changes]) / np.diff(changes)
    usual = float(np.median(slope))
    slope = np.append(np.where(slope > 0, np.minimum(slope, usual), usual), usual)
    run = np.cumsum(moves) - 1
    return np.asarray(time + slope[run] * (np.arange(len(time)) - changes[run]))


def _numbers_by_phase(time: Array) -> tuple[Integers, float] | None:
    """The number of each sample by the phase of the interval, (n,), and this, s.

    A single stamp may be nearer to the number beside its own; those about it are not. None where
    the stamps advance by no usual interval.
    """
    step, pieces = np.diff(time), len(time) // PHASE_SAMPLES
    usual = float(np.median(step))
    if usual <= 0 or pieces < MIN_WINDOWS:
        return None
    near = step[np.abs(step / usual - 1) < 1 / 2]
    if not len(near):  # half are much shorter, half much longer: packets
        return None
    in_pieces = time[: pieces * PHASE_SAMPLES].reshape(pieces, -1)

    def mean_phases(interval: float, first: int) -> Array:
        return np.asarray(np.exp(2j * np.pi * in_pieces[:first] / interval).mean(axis=1))

    tried = float(near.mean()) * (1 + PHASE_TRIALS)
    sharp = [float(np.abs(mean_phases(one, PHASE_PIECES)).sum()) for one in tried.tolist()]
    interval = float(tried[int(np.argmax(sharp))])
    turned = mean_phases(interval, pieces)
    phase = np.unwrap(np.angle(turned)) / (2 * np.pi)
    middle = np.arange(pieces) * PHASE_SAMPLES + PHASE_SAMPLES / 2
    place = np.arange(len(time))
    missing = np.rint(time / interval - np.interp(place, middle, phase)) - place
    missing = np.maximum.accumulate(median_filter(missing, PHASE_NEIGHBOURS, mode="nearest"))
    number = (place + missing - missing[0]).astype(np.int64)
    return (number, interval) if number[-1] * (1 - MAX_LOST_SHARE) < len(time) else None


def _numbers(missing: Integers) -> Integers:
    """The number of each sample, (n,), where so many are missing after each but the last."""
    return np.append(0, np.cumsum(missing + 1))


def _slope(time: Array, apart: int) -> float:
    """The median interval between stamps that are so many samples apart, s."""
    apart = max(apart, 1)
    return float(np.median(time[apart:] - time[:-apart])) / apart


def _least(delay: Array, window: int) -> Integers:
    """The place of the least delay in each whole window, (k,)."""
    k = len(delay) // window
    places = delay[: k * window].reshape(k, window).argmin(axis=1)
    return np.asarray(np.arange(k) * window + places)


def _longest_step(time: Array, resolution: float) -> float:
    """The longest step, s, that no time, (n,), divides where stamps are whole resolutions."""
    phase = np.sort(time % resolution)
    return float(np.diff(phase, append=phase[0] + resolution).max())


def _slope_sigma(number: Integers, left: Array, coarse: float) -> float:
    """Of the slope of a line through k values, what is left of them, (k,), s, by the line.

    By their scatter, with the correlation of neighbours (Newey & West 1987), and by the resolution
    `coarse` of its ends.
    """
    k, place = len(left), number - number.mean()
    lags = np.arange(1, int(np.sqrt(k)) + 1)
    alike = np.array([left[lag:] @ left[:-lag] for lag in lags]) / max(float(left @ left), TINY)
    together = max(1 + 2 * float((1 - lags / (len(lags) + 1)) @ alike), 1.0)
    scatter = together * float(left @ left) / max(k - 2, 1) / float(place @ place)
    return float(np.hypot(np.sqrt(scatter), coarse / (np.sqrt(6) * np.ptp(number))))


def _between_least(time: Array, interval: float, window: int) -> float:
    """The median interval between samples that arrive without delay, s, a few windows apart.

    That between all samples is off where packets do not divide the window: most are then as far
    apart as a whole number of packets, which is more or less than the window.
    """
    for _ in range(REFINEMENTS):
        least = _least(time - interval * np.arange(len(time)), window)
        if len(least) < MIN_WINDOWS:
            break
        apart = min(max(len(least) // MIN_WINDOW, 1), MAX_APART)
        first, last = least[:-apart], least[apart:]
        slope = float(np.median((time[last] - time[first]) / (last - first)))
        interval = slope if slope > 0 else interval
    return interval


def _set_back(time: Array, interval: float, window: int) -> Integers:
    """By how many samples the clock was set back after each stamp but the last, (n − 1,), ≤ 0."""
    missing = np.zeros(len(time) - 1, np.int64)
    for place in np.flatnonzero(np.diff(time) < -MAX_DELAY_S).tolist():
        delay = time - interval * _numbers(missing)
        before, after = delay[max(place + 1 - window, 0) : place + 1], delay[place + 1 :][:window]
        if (shift := float(after.min() - before.min())) < -MAX_DELAY_S:
            missing[place] = round(shift / interval)
    return missing


def _shortest_gap(delay: Array, interval: float, window: int) -> float:
    """The shortest gap that these delays show, s: by the scatter of the least ones."""
    between = np.diff(delay[_least(delay, window)])
    if not len(between):
        return MIN_SHIFT * interval
    scatter = MAD_TO_SIGMA * float(np.median(np.abs(between - np.median(between))))
    return max(MIN_SHIFT * interval, MIN_SHIFT_SIGMA * scatter)


def _gaps(delay: Array, interval: float, window: int, shortest: float) -> Integers:
    """How many samples are missing after each but the last, (n − 1,)."""
    step, delay = np.diff(delay), delay.copy()
    missing = np.zeros(len(step), np.int64)
    shift = _shifts(delay, window)
    # Of the last window nobody knows whether more samples would have come without delay.
    limit = np.full(len(step), shortest)
    limit[-window:] = max(shortest, MAX_DELAY_S)
    place = 0
    while (above := shift[place:] > limit[place:]).any():
        first = place + int(np.argmax(above))
        # Until the window has passed the gap every place shows it; the gap is the longest step.
        shown = first + int(np.argmin(np.append(shift[first : first + window] > shortest, False)))
        place = first + int(np.argmax(step[first:shown]))
        missing[place] = max(round(float(shift[place]) / interval), 1)
        delay[place + 1 :] -= missing[place] * interval
        near = slice(max(place - 2 * window, 0), place + 2 * window + 2)
        inner = slice(max(place - window, 0), place + window + 1)
        renewed = _shifts(delay[near], window)[inner.start - near.start :]
        shift[inner] = renewed[: len(shift[inner])]
        place += 1
    return missing


def _shifts(delay: Array, window: int) -> Array:
    """By how much the least delay of the window after each place exceeds that before, (n − 1,)."""
    half = window // 2
    before = minimum_filter1d(delay, window, mode="nearest", origin=window - 1 - half)
    after = minimum_filter1d(delay, window, mode="nearest", origin=-half)
    return np.asarray(after[1:] - before[:-1])
