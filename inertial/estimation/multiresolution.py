"""Powers of static stretches over all frequencies, from pieces, in bounded memory.

A stretch is seen at several levels: as it is, as means over 16 samples, over 16 of those, and so
on. A level with many values is cut into blocks of BLOCK; the first one with few enough is taken as
a whole. Each block is transformed by the orthonormal discrete cosine transform, whose coefficients
k = 1, 2, … have the frequencies k / (2 n Δ) and do not contain the mean. For white noise they are
exactly independent; for a random walk too (the transform diagonalises the Laplacian of a path, that
is, the inverse of its covariance), without the leakage that a periodogram would need a taper for;
for flicker noise but for the lowest. So their squares, in bins of frequency, are all that a
likelihood needs, except for the lowest coefficients of the whole, which are kept as they are.

Each level gives the frequencies below an eighth of its sampling rate, the first one all.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from scipy.fft import dct, rfft
from scipy.linalg import matmul_toeplitz

from inertial.arrays import Array, Booleans, Integers
from inertial.estimation.noise_model import rate_autocovariance
from inertial.estimation.spectrum import periodogram

_Sums = dict[tuple[int, int], tuple[float, Array, Array, float]]  # by level and bin

MEAN_OF = 16  # values of a level make one of the next
BLOCK = 1024  # values of a block
MAX_WHOLE = 8 * BLOCK  # values of a level that is taken as a whole
MIN_WHOLE = 64  # samples of a stretch that counts
OVERSAMPLED = 8  # sampling rate of a level over its highest frequency, except for the first
LOWEST = 24  # coefficients of a stretch that are kept as they are
MATRIX = 1024  # values, at the least, of which these are computed
BINS_PER_OCTAVE = 32  # narrow enough that a density hardly changes in one


@dataclass(frozen=True, eq=False)
class Bins:
    """Mean squares of coefficients in b bins of frequency.

    frequency: (b,), Hz; density: (b, c), both-sided, U²/Hz; degrees: (b,), squares in it; shapes:
    (4, b), expected density by the stochastic terms with coefficients of 1; level: (b,), from
    which the bin is; spacing: (b,), Hz, from one coefficient to the next.
    """

    level: Integers
    spacing: Array
    frequency: Array
    density: Array
    degrees: Array
    shapes: Array


@dataclass(frozen=True, eq=False)
class Lowest:
    """The lowest cosine coefficients of stretches that are equally long.

    count: stretches; shapes: (4, k, k), their covariance by the stochastic terms with coefficients
    of 1; ramp: (k,), their value by a drift of 1 U/s; sums: (c, k); products: (c, k, k); spacing:
    Hz, frequency of the first, by which they are apart.
    """

    spacing: float
    count: int
    shapes: Array
    ramp: Array
    sums: Array
    products: Array


@dataclass(eq=False)
class _Level:
    """The values of one level of the present stretch that no block has yet, and of no mean."""

    held: list[Array] = field(default_factory=list)
    unaveraged: list[Array] = field(default_factory=list)
    waiting: int = 0
    blocked: bool = False


class Powers:
    """Bins and lowest coefficients, from consecutive pieces of one stretch after the other."""

    def __init__(self, channels: int, interval: float) -> None:
        """`channels`: c; `interval`: s, between samples."""
        self.channels, self.interval = channels, interval
        self.seconds: list[float] = []
        self._bins: _Sums = {}
        self._squares: dict[int, tuple[int, Array]] = {}  # of the blocks of each level
        self._lowest: dict[tuple[float, int], Lowest] = {}
        self._levels = [_Level()]
        self._samples = 0
        self._origin = np.zeros(channels)

    def add(self, piece: Array) -> None:
        """The next samples of the stretch, (n, c), at a regular interval, none missing."""
        if not self._samples and len(piece):
            self._origin = np.array(
                piece[0], np.float64
            )  # a constant is lost, but not its rounding
        self._samples += len(piece)
        # So many that the blocks of the first level are cut at once, in bounded memory.
        for start in range(0, len(piece), MAX_WHOLE):
            self._add(0, piece[start : start + MAX_WHOLE] - self._origin)

    def _add(self, number: int, values: Array) -> None:
        if number == len(self._levels):
            self._levels.append(_Level())
        level = self._levels[number]
        level.held.append(values)
        level.waiting += len(values)
        if level.waiting >= MAX_WHOLE:
            joined = np.concatenate(level.held)
            whole = len(joined) // BLOCK * BLOCK
            self._blocks(number, joined[:whole])
            level.held, level.waiting = [joined[whole:]], len(joined) - whole
            level.blocked = True
        level.unaveraged.append(values)
        if sum(map(len, level.unaveraged)) >= MEAN_OF:
            joined = np.concatenate(level.unaveraged)
            whole = len(joined) // MEAN_OF * MEAN_OF
            level.unaveraged = [joined[whole:]]
            shape = (-1, MEAN_OF, self.channels)
            self._add(number + 1, joined[:whole].reshape(shape).mean(axis=1))

    def end(self) -> None:
        """The stretch ends: the next piece belongs to another one."""
        for number, level in enumerate(self._levels):
            values = np.concatenate(level.held) if level.held else np.zeros((0, self.channels))
            if not level.blocked:
                if self._samples >= MIN_WHOLE:
                    self._whole(number, values)
                break
            whole = len(values) // BLOCK * BLOCK
            if whole:
                self._blocks(number, values[:whole])
        if self._samples:
            self.seconds.append(self._samples * self.interval)
        self._levels = [_Level()]
        self._samples = 0

    def _blocks(self, number: int, values: Array) -> None:
        blocks = values.reshape(-1, BLOCK, self.channels)
        coefficients = dct(_without_trend(blocks), axis=1, norm="ortho", overwrite_x=True)
        count, squares = self._squares.get(number, (0, np.zeros((BLOCK, self.channels))))
        squares += np.einsum("bkc,bkc->kc", coefficients, coefficients)
        self._squares[number] = count + len(blocks), squares

    def _whole(self, number: int, values: Array) -> None:
        step = self.interval * MEAN_OF**number
        mean_of = max(len(values) // MATRIX, 1)
        count = len(values) // mean_of
        values = values[: count * mean_of]
        means = values.reshape(count, mean_of, -1).mean(axis=1)
        lowest = min(LOWEST, count - 1)
        kept = dct(means, axis=0, norm="ortho")[1 : lowest + 1].T
        key = (step * mean_of, count)
        known = self._lowest.get(key)
        if known is None:
            shapes, ramp = lowest_shapes(count, step * mean_of, lowest)
            sums, products = np.zeros_like(kept), np.zeros((len(kept), lowest, 1))
            spacing = 1 / (2 * count * step * mean_of)
            known = Lowest(spacing, 0, shapes, ramp, sums, products)
        self._lowest[key] = replace(
            known,
            count=known.count + 1,
            sums=known.sums + kept,
            products=known.products + kept[:, :, None] * kept[:, None, :],
        )
        squares = dct(_without_trend(values[None])[0], axis=0, norm="ortho") ** 2
        self._collect(self._bins, number, lowest + 1, squares, 1)

    def _collect(self, bins: _Sums, number: int, first: int, squares: Array, count: int) -> None:
        """Add the squares (n, c) of the coefficients from the first one to the bins of a level."""
        length = len(squares)
        step = self.interval * MEAN_OF**number
        after = length if number == 0 else 2 * length // OVERSAMPLED
        if after <= first:
            return
        bin_, edges, shapes = _binned(length, first, after, step)
        powers = np.add.reduceat(squares[first:after] * step, edges, axis=0)
        degrees = np.diff(np.append(edges, after - first)) * float(count)
        for i, name in enumerate(bin_.tolist()):
            known = bins.get((number, name), (0.0, np.zeros(self.channels), np.zeros(4), 0.0))
            more, power, shape = degrees[i], powers[i], shapes[:, i] * count
            each = more / (2 * length * step)
            bins[number, name] = (
                known[0] + more,
                known[1] + power,
                known[2] + shape,
                known[3] + each,
            )

    def bins(self) -> Bins:
        """The bins of all stretches that have ended, by frequency."""
        bins = dict(self._bins)
        first = 2 * BLOCK // (OVERSAMPLED * MEAN_OF)
        for number, (count, squares) in self._squares.items():
            self._collect(bins, number, first, squares, count)
        found = [
            (
                2 ** ((name + 0.5) / BINS_PER_OCTAVE) / (self.interval * MEAN_OF**number),
                number,
                sums,
            )
            for (number, name), sums in bins.items()
        ]
        rows = sorted(found, key=lambda row: row[:2])
        degrees = np.array([row[2][0] for row in rows])
        return Bins(
            np.array([row[1] for row in rows], np.int64),
            np.array([row[2][3] for row in rows]) / degrees,
            np.array([row[0] for row in rows]),
            np.array([row[2][1] for row in rows]).reshape(-1, self.channels) / degrees[:, None],
            degrees,
            np.array([row[2][2] for row in rows]).reshape(-1, 4).T / degrees,
        )

    def lowest(self) -> Iterator[Lowest]:
        """The lowest coefficients, by length."""
        yield from self._lowest.values()


def _without_trend(blocks: Array) -> Array:
    """Blocks (b, n, c) less their straight lines: a drift would leak to the higher coefficients."""
    time = np.arange(blocks.shape[1]) - (blocks.shape[1] - 1) / 2
    slope = np.einsum("n,bnc->bc", time, blocks) / (time @ time)
    return np.asarray(blocks - blocks.mean(axis=1, keepdims=True) - slope[:, None] * time[:, None])


@cache
def _binned(length: int, first: int, after: int, step: float) -> tuple[Integers, Integers, Array]:
    """Bins of the coefficients [first, after): names, first places, and shapes summed in them."""
    k = np.arange(first, after)
    turn = k / (2 * length)
    name = np.floor(np.log2(turn) * BINS_PER_OCTAVE).astype(np.int64)
    edges = np.append(0, np.flatnonzero(np.diff(name)) + 1)
    shapes = step * coefficient_variances(length, step)[:, first:after]
    return name[edges], edges, np.add.reduceat(shapes, edges, axis=1)


def coefficient_variances(count: int, interval: float) -> Array:
    """Variances of the cosine coefficients 0 … n − 1 of n samples by each term, (4, n), U².

    Stochastic terms with coefficients of 1. For a stationary covariance γ they are
    γ(0) + 2/n Σ γ(h) [(n − h) cos(πkh/n) − sin(πkh/n) / sin(πk/n)], h = 1 … n − 1.
    """
    gamma = rate_autocovariance(count, interval)
    lags, k = np.arange(count), np.arange(1, count)
    weighted = rfft(gamma * (count - lags), 2 * count, axis=1)[:, 1:count].real
    sines = -rfft(gamma, 2 * count, axis=1)[:, 1:count].imag
    # With the term of h = 0 in both sums, whose weight is n, twice.
    variances = np.zeros((4, count))
    variances[:, 1:] = 2 / count * (weighted - sines / np.sin(np.pi * k / count)) - gamma[:, :1]
    return variances


@cache
def lowest_shapes(count: int, interval: float, lowest: int) -> tuple[Array, Array]:
    """Of the coefficients 1 … `lowest` of `count` means: covariance by each term, and a ramp's.

    Returns
    -------
    (4, k, k), by the stochastic terms with coefficients of 1; (k,), by a drift of 1 U/s
    """
    k = np.arange(1, lowest + 1)
    rows = np.sqrt(2 / count) * np.cos(np.pi * k[:, None] * (np.arange(count) + 0.5) / count)
    shapes = np.stack(
        [rows @ matmul_toeplitz(gamma, rows.T) for gamma in rate_autocovariance(count, interval)]
    )
    ramp = rows @ (interval * (np.arange(count) - (count - 1) / 2))
    return (shapes + shapes.transpose(0, 2, 1)) / 2, np.asarray(ramp)


# ---- Welch's power spectrum of static stretches, from pieces, for drawing beside the model.
#
# Segments of a stretch that overlap by half, less their means and Hann-weighted; no segment spans a
# gap, and a stretch shorter than a segment does not contribute. For frequencies below the segments'
# the same is done with means over 4 samples, and over 4 of those; of these only what is below a
# sixteenth of their sampling rate is used, where a mean changes the density by 1.3 % at the most.
#
# The degrees of freedom account for the overlap and for neighbouring bins, which a Hann window
# correlates: by (1/6)² and by (2/3)², (1/6)² (P. D. Welch, IEEE Trans. Audio Electroacoust. 15,
# 1967, 70; G. Heinzel et al., Spectrum and spectral density estimation by the DFT, 2002).

MEAN_OF_FOR_DRAWING = 4  # values of a level make one of the next
OVERSAMPLED_FOR_DRAWING = (
    16  # sampling rate of a level over its highest frequency, except for the first
)
SEGMENTS = (64, 1024)  # values of a segment, at the least and at the most
LONGEST_SEGMENTS = 4  # segments in the longest stretch, at the least
FIRST_BIN = 2.5  # bins: below it, what is slower than a segment leaks in
BATCH = 16  # segments that are transformed together
BINS_PER_DECADE = 30  # of the drawn spectrum
OVERLAP = (1 / 6) ** 2  # squared correlation of segments that overlap by half
NEIGHBOUR = ((2 / 3) ** 2, (1 / 6) ** 2)  # and of a bin with the next, and the next but one


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Power density in b bins of frequency.

    frequency: (b,), Hz, mean of the bin; edges: (b, 2), Hz; density: (b, c), both-sided, U²/Hz, as
    N² of a white noise N; degrees: (b,), equivalent degrees of freedom.
    """

    frequency: Array
    edges: Array
    density: Array
    degrees: Array

    def in_ranges(self, ranges: Array) -> Booleans:
        """Which bins lie in one of the ranges of frequency, (l, 2), Hz, at least in part: (b,)."""
        touched = (self.edges[:, :1] <= ranges[:, 1]) & (self.edges[:, 1:] >= ranges[:, 0])
        return np.asarray(touched.any(axis=1))


def segment_for(lengths: Sequence[int]) -> int:
    """The length of the segments for stretches of so many samples, a power of two."""
    least, most = SEGMENTS
    longest = max(lengths, default=0) // LONGEST_SEGMENTS
    return int(np.clip(2 ** int(np.log2(max(longest, 1))), least, most))


class WelchSums:
    """Sums of periodograms, from consecutive pieces of one stretch after the other."""

    def __init__(self, channels: int, interval: float, segment: int) -> None:
        """`channels`: c; `interval`: s, between samples; `segment`: samples."""
        self.channels, self.interval, self.segment = channels, interval, segment
        self._power: list[Array] = []
        self._count: list[int] = []
        self.end()

    def end(self) -> None:
        """The stretch ends: the next piece belongs to another one."""
        self._held: list[Array] = []
        self._unaveraged: list[Array] = []

    def add(self, piece: Array) -> None:
        """The next samples of the stretch, (n, c), at a regular interval, none missing."""
        values = np.asarray(piece, np.float64)
        level = 0
        while len(values):
            if level == len(self._held):
                self._held.append(np.zeros((0, self.channels)))
                self._unaveraged.append(np.zeros((0, self.channels)))
            self._held[level] = self._segments(level, np.concatenate([self._held[level], values]))
            values = np.concatenate([self._unaveraged[level], values])
            whole = len(values) // MEAN_OF_FOR_DRAWING * MEAN_OF_FOR_DRAWING
            self._unaveraged[level] = values[whole:]
            values = values[:whole].reshape(-1, MEAN_OF_FOR_DRAWING, self.channels).mean(axis=1)
            level += 1

    def _segments(self, level: int, values: Array) -> Array:
        """Add the segments of a level; what the next one needs is returned."""
        half = self.segment // 2
        count = len(values) // half - 1
        if count < 1:
            return values
        if level == len(self._power):
            self._power.append(np.zeros((half - 1, self.channels)))
            self._count.append(0)
        rate = 1 / (self.interval * MEAN_OF_FOR_DRAWING**level)
        windows = np.lib.stride_tricks.sliding_window_view(values, self.segment, axis=0)[::half]
        for start in range(0, count, BATCH):  # a few at a time: memory
            some = windows[start : min(start + BATCH, count)]
            centred = some - some.mean(axis=-1, keepdims=True)
            self._power[level] += periodogram(centred, rate).sum(axis=0).T
        self._count[level] += count
        return values[count * half :]

    def spectrum(self, per_decade: int = BINS_PER_DECADE) -> Spectrum:
        """The mean of all segments of all stretches, in bins of frequency."""
        rows = []
        for level, (power, count) in enumerate(zip(self._power, self._count, strict=True)):
            rate = 1 / (self.interval * MEAN_OF_FOR_DRAWING**level)
            frequency = np.arange(1, self.segment // 2) * rate / self.segment
            last = level + 1 == len(self._power)
            lowest = FIRST_BIN * rate / self.segment
            used = frequency >= (
                lowest
                if last
                else max(rate / MEAN_OF_FOR_DRAWING / OVERSAMPLED_FOR_DRAWING, lowest)
            )
            used &= frequency < rate / (OVERSAMPLED_FOR_DRAWING if level else 2)
            name = np.floor(np.log10(frequency * self.interval) * per_decade)
            independent = count / (1 + 2 * OVERLAP * (1 - 1 / count))
            for one in np.unique(name[used]):
                own = used & (name == one)
                bins = int(own.sum())
                alike = 1 + 2 * sum(
                    share * max(1 - (i + 1) / bins, 0) for i, share in enumerate(NEIGHBOUR)
                )
                half_width = rate / self.segment / 2
                rows.append(
                    (
                        float(frequency[own].mean()),
                        (frequency[own].min() - half_width, frequency[own].max() + half_width),
                        power[own].mean(axis=0) / count,
                        2 * independent * bins / alike,
                    )
                )
        rows.sort(key=lambda row: row[0])
        return Spectrum(
            np.array([row[0] for row in rows]),
            np.array([row[1] for row in rows]).reshape(-1, 2),
            np.array([row[2] for row in rows]).reshape(-1, self.channels),
            np.array([row[3] for row in rows]),
        )
