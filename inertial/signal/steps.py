"""Sudden changes of level in noisy readings: where, how large, how sure."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded
from scipy.ndimage import median_filter, uniform_filter1d
from scipy.special import chdtrc, ndtri, stdtr

from inertial.arrays import Array, Integers
from inertial.signal.scatter import MAD_TO_SIGMA, in_blocks, median

MAX_SIDE_S = 10.0  # s on each side that are compared at most: further away a bias may have wandered
MIN_LEVEL_S = 0.2  # s that a level has to last: what is shorter is a knock or a spike
MIN_LEVEL_READINGS = 4  # readings that a level has to last
# Windows that fit into a record, at least, for its own scatter to give their noise
MIN_WINDOWS = 16
MIN_SURE_WINDOWS = 128  # and as many for the noise to be known well: about 30 degrees of freedom
DIFFERENCES_PER_WIDTH = 8  # differences that are examined in each width
MAX_DIFFERENCES = 2**14  # differences that give a scatter, which is then known to one per cent
MAX_DEVIATION_SIGMA = 5.0  # sigmas from the running median: a spike is no step
# Fall of twice the log likelihood about a change, 95 %: Hansen, Econometrica 68, 2000
PLACE_LIKELIHOOD = 7.35
# Chi-squared by which a ramp of the width that is excluded fits worse on average
RAMP_CHI_SQUARED = 60.0
FILTER_S = 0.25  # s, what an instrument's own filter may make of a step
MIN_CHI_SQUARED_GAIN = 12.0  # chi-squared by which a step must fit better than everything smooth
MIN_COLOURED_RATIO = 1.6  # times what shorter means scatter by, for their length: noise that grows
RESOLVING_READINGS = 800.0  # readings on each side that distinguish a step of one sigma from a bend
MAX_VARIANCE_RATIO = 3.0  # times the usual variance about the two levels: a motion, no level
MAX_CORRECTION_SHARE = 0.3  # of a step, what may be left of it at first
MIN_STEP_SIGMA = 6.0  # sigmas that are left of a step once all others and the trend are taken off
MAX_STEPS = 40  # steps of one record
# Variance of a random walk from block to block, over that of a block mean
WALKS = (0.0, *np.logspace(-5, 2, 22))
FIT_POINTS = 500  # to which a window is reduced where smooth courses are fitted


@dataclass(frozen=True)
class Step:
    """A change of level among n readings.

    place: first reading at the new level; earliest, latest: where it may be instead, 95 %;
    size, sigma: in the unit of the readings; p_value: chance of it in noise, the search within
    these readings paid for; reach: readings on each side in which it was seen.
    """

    place: int
    earliest: int
    latest: int
    size: float
    sigma: float
    p_value: float = 1.0
    reach: int = 0


def steps(readings: Array, interval: float, quantum: float, level: float) -> list[Step]:
    """The steps in (n,) readings, in their order.

    Windows of 0.2 s to 10 s on both sides of every place are compared, each length by the scatter
    that such differences have in these readings: so an oscillation, excess noise and a bias that
    wanders count as noise. A change that something smooth explains as well, be it drift, a random
    walk or a settling after motion, is none.

    interval: s; quantum: smallest step of the readings; level: accepted p-value.
    """
    n = len(readings)
    shortest = max(MIN_LEVEL_READINGS, round(MIN_LEVEL_S / interval))
    longest = min(n // 2, round(MAX_SIDE_S / interval))
    if n < MIN_WINDOWS * MIN_LEVEL_READINGS or longest < shortest:
        return []
    clean = without_spikes(readings)
    detected: list[Step] = []
    refused = np.full(n, longest + 1)  # from this width on, what is there was refused
    while len(detected) < MAX_STEPS:
        rest = clean - _course(detected, n)
        noise = _Noise(rest, longest, quantum)
        p_value, place, width = _strongest(noise, shortest, refused)
        if p_value > level:
            break
        step = _fitted(rest, place, width, noise, FILTER_S / interval)
        beside = (
            []
            if step is None
            else [other for other in detected if _corrects(step, other, shortest)]
        )
        if step is None or beside:
            near = slice(max(place - width, 0), place + width + 1)
            refused[near] = np.minimum(refused[near], width)
        if beside:
            # Its size was taken from too few readings.
            detected = [
                replace(other, reach=longest) if other in beside else other for other in detected
            ]
        elif step is not None:
            detected = [*detected, replace(step, p_value=p_value)]
        detected = _together(clean, detected, noise, places=False)
    if not detected:
        return []
    # With all others known, each is fitted to all that is between them.
    noise = _Noise(clean - _course(detected, n), longest, quantum)
    wide = [replace(step, reach=longest) for step in detected]
    detected = _together(clean, wide, noise, places=True)
    edges = np.array([0, *(step.place for step in detected), n])
    lasts = np.minimum(edges[1:-1] - edges[:-2], edges[2:] - edges[1:-1]) >= shortest
    significant = np.array(
        [abs(step.size) > MIN_STEP_SIGMA * step.sigma for step in detected], bool
    )
    kept = [step for step, kept in zip(detected, lasts & significant, strict=True) if kept]
    chances = [
        max(step.p_value, _chance_in_walk(clean - _course([*set(kept) - {step}], n), step.place))
        for step in kept
    ]
    return [
        replace(step, p_value=chance)
        for step, chance in zip(kept, chances, strict=True)
        if chance <= level
    ]


def _chance_in_walk(readings: Array, place: int) -> float:
    """The chance of a step here or elsewhere in (n,) readings, if their bias is a random walk.

    How large the walk is, is not known: it is what makes the readings likeliest, without the step
    and with it. Of N block means the N − 1 differences have the variance 2σ² + 2q/3 and beside each
    other the covariance q/6 − σ²; twice the gain in log likelihood by a step is chi-squared.
    """
    per = -(-len(readings) // FIT_POINTS)
    before, after = readings[place % per : place], readings[place:]
    means = [in_blocks(part, per).mean(axis=1) for part in (before, after)]
    change = np.diff(np.concatenate(means))
    count, drift = len(change), np.ones(len(change))
    step = np.zeros(count)
    step[len(means[0]) - 1] = 1.0
    likelihoods = []
    for walk in WALKS:
        band = np.full((2, count), 2 + 2 * walk / 3)
        band[0] = walk / 6 - 1
        factor = cholesky_banded(band)
        white = [cho_solve_banded((factor, False), x) for x in (change, drift, step)]
        inner = np.array([[x @ y for y in white] for x in (change, drift, step)])
        squares = inner[0, 0] - inner[0, 1] ** 2 / inner[1, 1]
        own = inner[2, 2] - inner[1, 2] ** 2 / inner[1, 1]
        gain = (inner[0, 2] - inner[0, 1] * inner[1, 2] / inner[1, 1]) ** 2 / own
        spread = 2 * float(np.log(factor[1]).sum())
        likelihoods.append([-count * np.log(left) - spread for left in (squares, squares - gain)])
    without, with_it = np.max(likelihoods, axis=0)
    return float(min(count * chdtrc(1, max(with_it - without, 0.0)), 1.0))


def _corrects(step: Step, other: Step, shortest: int) -> bool:
    """Whether a step is what is left of another one whose size was not well known."""
    near = abs(step.place - other.place) < shortest
    return near and abs(step.size) < MAX_CORRECTION_SHARE * abs(other.size)


def without_spikes(readings: Array) -> Array:
    """The readings, (n,), with what one or two of them stick out of their neighbours cut off."""
    middle = median_filter(readings, 5, mode="nearest")
    scatter = MAD_TO_SIGMA / np.sqrt(2) * median(np.abs(np.diff(readings)))
    return np.asarray(
        np.clip(
            readings, middle - MAX_DEVIATION_SIGMA * scatter, middle + MAX_DEVIATION_SIGMA * scatter
        )
    )


def _cumulative(readings: Array) -> Array:
    """The sums of the first k readings, (n + 1,), each less the first reading, of (n,)."""
    return np.append(0.0, np.cumsum(readings - readings[0]))


def _differences(total: Array, width: int, apart: int = 1) -> Array:
    """Mean of the `width` readings from k on, less that of those before, k = width … n − width.

    total : sums of the readings, from `_cumulative`; apart : from one k to the next
    """
    before, here, after = (
        total[: -2 * width : apart],
        total[width:-width:apart],
        total[2 * width :: apart],
    )
    return np.asarray((after - 2 * here + before) / width)


def _white(change: Array, width: int) -> float:
    """Scatter of white readings whose neighbouring means of so many would differ so."""
    return float(MAD_TO_SIGMA * median(np.abs(change)) * np.sqrt(width / 2))


class _Noise:
    """What differences of neighbouring means scatter by, at every length of the mean."""

    def __init__(self, readings: Array, longest: int, quantum: float) -> None:
        self.readings = readings
        self.quantum = quantum
        self.least = quantum / np.sqrt(12)
        self.widths: list[int] = []
        self.single: list[float] = []  # what a reading would scatter by if the noise were white
        self.trend: list[float] = []  # of an even drift, usual change from mean to mean
        changes: list[Array] = []
        self.total = _cumulative(readings)
        width = 1
        while width <= min(longest, len(readings) // MIN_WINDOWS):
            # Neighbours share nearly all their readings: some give the scatter as well as all.
            apart = max(width // DIFFERENCES_PER_WIDTH, len(readings) // MAX_DIFFERENCES, 1)
            change = _differences(self.total, width, apart)
            trend = float(median(change))
            self.widths.append(width)
            self.trend.append(trend)
            self.single.append(_white(change - trend, width))
            changes.append(change)
            width *= 2
        # The drift not taken off.
        whole = [_white(*each) for each in zip(changes[-4:], self.widths[-4:], strict=True)]
        self.coloured = whole[-1] > MIN_COLOURED_RATIO * min(whole)
        # Drift and noise that grows are unknown beyond the lengths at which they were observed.
        self.longest = min(longest, self.widths[-1]) if self.coloured else longest

    def white(self, width: int) -> float:
        """Scatter of a reading such that white noise makes means of this width scatter so.

        The largest of four lengths up to this one, or to the longest that the record resolves:
        so noise that grows with time, or is poorly known, is overestimated rather than under.
        """
        known = [s for w, s in zip(self.widths, self.single, strict=True) if w <= width]
        return float(max(self.least, *known[-4:]))

    def drift(self, width: int) -> float:
        """What two neighbouring means of `width` readings usually differ by."""
        return float(np.interp(width, self.widths, self.trend)) if self.coloured else 0.0

    def of_difference(self, width: int) -> float:
        """Scatter of the difference of two means of `width` readings."""
        return self.white(width) * float(np.sqrt(2 / width))

    def degrees(self, width: int) -> float:
        """Degrees of freedom of this scatter: the median uses 0.37 of n/1.5 independent ones."""
        n = len(self.readings)
        return (
            0.37 / 1.5 * n / (width if self.coloured else min(width, max(n // MIN_SURE_WINDOWS, 1)))
        )

    def variance(self, width: int) -> float:
        """Usual variance of the readings about their mean over this width."""
        deviation = self.readings - uniform_filter1d(self.readings, width)
        return float(max((MAD_TO_SIGMA * median(np.abs(deviation))) ** 2, self.least**2))


def _strongest(noise: _Noise, shortest: int, refused: Integers) -> tuple[float, int, int]:
    """The difference that is least probable by chance: its p-value, place and width."""
    best = (1.0, 0, 0)
    width = shortest
    while width <= noise.longest:
        size = np.abs(_differences(noise.total, width) - noise.drift(width))
        size[refused[width : width + len(size)] <= width] = 0.0
        k = int(np.argmax(size))
        z = float(size[k]) / max(noise.of_difference(width), 1e-300)
        # A scale has about n/width independent places, so all of them together about n.
        p_value = 2 * float(stdtr(noise.degrees(width), -z)) * len(noise.readings)
        best = min(best, (p_value, k + width, width))
        width = min(2 * width, noise.longest) if width < noise.longest else noise.longest + 1
    return best


def _fitted(rest: Array, place: int, width: int, noise: _Noise, quick: float) -> Step | None:
    """The step at about this place, if nothing smooth explains what is seen there.

    Where the windows are too short to decide, longer ones are tried as well.
    """
    step = _within(rest, place - width, place + width, noise, quick)
    if step is None:
        size = _placed(rest[place - width : place + width], noise, width).size
        resolving = RESOLVING_READINGS * (noise.white(width) / max(abs(size), 1e-300)) ** 2
        wider = int(min(resolving, place, len(rest) - place, noise.longest))
        if wider > width:
            step = _within(rest, place - wider, place + wider, noise, quick)
    return step


def _within(rest: Array, first: int, after: int, noise: _Noise, quick: float) -> Step | None:
    y = rest[first:after]
    step = _placed(y, noise, (after - first) // 2)
    sigma = noise.white((after - first) // 2)
    # Readings that hardly leave one count jump by a count where something drifts past its border.
    rounded = noise.single[0] < noise.quantum / 2 and abs(step.size) < 1.5 * noise.quantum
    narrow = max(12 * RAMP_CHI_SQUARED * (sigma / max(abs(step.size), 1e-300)) ** 2, quick)
    if rounded or narrow > len(y):
        return None
    # Chi-squared of block means is that of the readings, less what is within the blocks.
    per = -(-len(y) // FIT_POINTS)
    blocks = in_blocks(y, per).mean(axis=1)
    at = np.asarray((np.arange(len(blocks)) + 0.5) * per, np.float64)
    weight = per / sigma**2
    best = _misfit(blocks, at, np.clip((at - step.place) / per + 0.5, 0, 1)) * weight
    smooth = min(_misfit(blocks, at, course) for course in _courses(at, step.place, narrow))
    if smooth * weight - best < MIN_CHI_SQUARED_GAIN:
        return None
    left = y - step.size * (np.arange(len(y)) >= step.place)
    near = slice(max(step.place - 64, 0), step.place + 64)
    if float(np.var(left[near])) > MAX_VARIANCE_RATIO * noise.variance(2 * len(y)):
        return None
    return replace(
        step,
        place=first + step.place,
        earliest=first + step.earliest,
        latest=first + step.latest,
        reach=(after - first) // 2,
    )


def _placed(y: Array, noise: _Noise, width: int, only: int | None = None) -> Step:
    """The step that fits m readings best beside a level and a trend; `only`: at this place."""
    m = len(y)
    t = np.arange(m) - (m - 1) / 2
    level = y - y.mean()
    straight = level - t * float(level @ t) / float(t @ t)
    k = (
        np.arange(MIN_LEVEL_READINGS, m - MIN_LEVEL_READINGS + 1)
        if only is None
        else np.array([only])
    )
    after = -np.cumsum(straight)[k - 1]  # the sum of what follows
    own = k * (m - k) / m - (k * (m - k) / 2) ** 2 / float(t @ t)
    size, sigma = after / own, noise.white(width)
    # An oscillation that a long mean does not see moves the place nevertheless.
    gain = after**2 / own / max(sigma, *noise.single) ** 2
    best = int(np.argmax(gain))
    likely = k[gain >= gain[best] - PLACE_LIKELIHOOD]
    return Step(
        int(k[best]),
        int(likely[0]),
        int(likely[-1]),
        float(size[best]),
        float(sigma / np.sqrt(own[best])),
    )


def _courses(at: Array, place: int, narrow: float) -> Iterator[Array]:
    """Courses that resemble a step: bends, settling, ramps of at least this width."""
    end = float(at[-1])
    yield np.column_stack([at**2, at**3])
    for share in (1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1):
        yield np.exp(-at / (share * end))
    width = narrow
    while width <= end:
        for shift in (-0.5, -0.25, 0, 0.25, 0.5):
            ramp = np.clip((at - place) / width + 0.5 + shift, 0, 1)
            if ramp.any():  # one that begins after the last block is none
                yield ramp
        width *= 2


def _misfit(y: Array, at: Array, course: Array) -> float:
    """Sum of squares that a level, a trend and a course leave."""
    design = np.column_stack([np.ones(len(at)), at / at[-1], course])
    design = design / np.linalg.norm(design, axis=0)
    solution = np.linalg.lstsq(design, y, rcond=None)[0]
    return float(np.sum((y - design @ solution) ** 2))


def _course(detected: Sequence[Step], n: int) -> Array:
    """What these steps make of n readings."""
    course = np.zeros(n)
    for step in detected:
        course[step.place :] += step.size
    return course


def _together(
    readings: Array, detected: Sequence[Step], noise: _Noise, *, places: bool
) -> list[Step]:
    """Every step once more, between its neighbours and without the others; in their order.

    places: they are estimated again; else the sizes alone.
    """
    n = len(readings)
    now = sorted(detected, key=lambda step: step.place)
    for _ in range(2):
        edges = [0, *(step.place for step in now), n]
        for i, step in enumerate(now):
            first = max(edges[i], step.place - step.reach)
            after = min(edges[i + 2], step.place + step.reach)
            if min(step.place - first, after - step.place) < MIN_LEVEL_READINGS:
                continue
            others = [other for other in now if other is not step]
            own = (readings - _course(others, n))[first:after]
            only = None if places else step.place - first
            again = _placed(own, noise, (after - first) // 2, only)
            now[i] = replace(
                again,
                place=first + again.place,
                earliest=first + again.earliest,
                latest=first + again.latest,
                p_value=step.p_value,
                reach=step.reach,
            )
    return sorted(now, key=lambda step: step.place)


# ---- Where the mean of a series changes, and stays changed for a while.

MIN_CHANGE_SIGMA = 5.0  # sigma: 6·10⁻⁷ for one place, and errors of stamps cancel, so in truth less
MAX_BORDERS = 4  # of the largest differences of blocks, which may be borders


def changes(series: Array, length: int, shortest: int, least: float, finest: float) -> list[int]:
    """The borders of the parts of a series, (n,), that have each a mean of its own: 0, …, n.

    Binary segmentation by the likelihood ratio of a step in white noise, over means of blocks,
    for the errors of stamps cancel within a block; then to the value. Scott & Knott, Biometrics
    30 (1974), 507.

    Parameters
    ----------
    length : values of a block
    shortest : blocks that a part has at least
    least : means that differ by less are the same
    finest : sigma of the mean of a block is at least this
    """
    blocks = in_blocks(series, length).mean(axis=1)
    if len(blocks) < 2 * shortest:
        return [0, len(series)]
    sigma = max(_scatter(blocks), finest)
    borders = [0, len(series)]
    waiting = [(0, len(series))]
    while waiting:
        start, end = waiting.pop()
        step = _step(in_blocks(series[start:end], length).mean(axis=1), shortest, sigma)
        if step:
            border = start + _to_the_value(series[start:end], step * length, length)
            borders.append(border)
            waiting += [(start, border), (border, end)]
    return _told_apart(series, sorted(borders), least, sigma * np.sqrt(length))


def _scatter(blocks: Array) -> float:
    """The sigma of a block, from differences of neighbours without the largest."""
    squares = np.sort(np.diff(blocks) ** 2)
    kept = max(len(squares) - MAX_BORDERS, 1)
    # What is left of the variance of Gaussian values without those beyond the bound.
    share = kept / len(squares)
    bound = float(ndtri((1 + share) / 2))
    left = (
        1 - 2 * bound * np.exp(-(bound**2) / 2) / np.sqrt(2 * np.pi) / share if share < 1 else 1.0
    )
    return float(np.sqrt(squares[:kept].mean() / 2 / left))


def _step(blocks: Array, shortest: int, sigma: float) -> int:
    """Before which block the mean most likely changes; 0 if nowhere."""
    n = len(blocks)
    if n < 2 * shortest:
        return 0
    k = np.arange(shortest, n - shortest + 1)
    away = np.cumsum(blocks - blocks.mean())[k - 1]
    likely = np.abs(away) / np.sqrt(k * (n - k) / n)
    best = int(np.argmax(likely))
    return int(k[best]) if likely[best] > MIN_CHANGE_SIGMA * sigma else 0


def _to_the_value(series: Array, border: int, length: int) -> int:
    """The border of two means, within two blocks of `border`, with the least squares left over."""
    before, after = series[: border - length].mean(), series[border + length :].mean()
    start, end = max(border - 2 * length, 0), min(border + 2 * length, len(series))
    near = series[start:end]
    squares = np.cumsum((near - before) ** 2 - (near - after) ** 2)
    return start + 1 + int(np.argmin(squares[:-1]))


def _told_apart(series: Array, borders: list[int], least: float, sigma: float) -> list[int]:
    """The borders without those on both sides of which the mean is the same.

    That is within `least`, or within what values that scatter by `sigma` are sure of.
    """
    while len(borders) > 2:
        means = [float(series[a:b].mean()) for a, b in pairwise(borders)]
        unsure = (
            MIN_CHANGE_SIGMA * sigma * np.sqrt(1 / np.diff(borders)[1:] + 1 / np.diff(borders)[:-1])
        )
        apart = np.abs(np.diff(means)) / np.maximum(unsure, least)
        nearest = int(np.argmin(apart))
        if apart[nearest] >= 1:
            break
        borders = borders[: nearest + 1] + borders[nearest + 2 :]
    return borders
