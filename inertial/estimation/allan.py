"""Overlapping Allan deviation of static stretches, with confidence intervals.

    σ²(τ) = 1/2 ⟨(ȳ(t + τ) − ȳ(t))²⟩,    ȳ(t) the mean rate from t to t + τ = m Δ

over every start t of a stretch. The rule for gaps and masks: a stretch ends there, and no average
spans its end. A stretch of n samples contributes to the averaging times up to MAX_SHARE of its
length; stretches are pooled with the numbers of their terms, n − 2m + 1, as weights.

The equivalent degrees of freedom follow from the autocovariance of the terms under a model of the
noise, of one kind or of several (C. A. Greenhall and W. J. Riley, Uncertainty of stability
variances based on finite differences, PTTI 2003; for single kinds NIST SP 1065, section 5.4.1);
those of stretches are combined as independent.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.noise_model import NoiseModel, angle_autocovariance
from inertial.estimation.probability import chi2_isf

FACTORS_PER_DECADE = 10
MAX_SHARE = 0.25  # of a stretch, that an averaging time may be: 3 independent differences
MAX_EXACT_FACTOR = 1 << 20  # samples; longer averages start at every STRIDE-th sample only
STRIDE = 64
BLOCK = 16384  # samples that are differenced together: three arrays of them fit into a cache
LAGS_PER_TAU = 32  # of the sum over lags that gives the degrees of freedom
MAX_LAG_TAUS = 16  # farther off, differences are independent
ONE_SIGMA = 0.15865525393145707  # probability of each tail
# Exponents of the density of the rate by the lag-1 autocorrelation, as terms of the model
BY_EXPONENT = {
    2: NoiseModel(quantisation=1.0),
    0: NoiseModel(white_noise=1.0),
    -1: NoiseModel(bias_instability=1.0),
    -2: NoiseModel(random_walk=1.0),
}


def factors_up_to(largest: int, per_decade: int = FACTORS_PER_DECADE) -> Integers:
    """Averaging factors from 1, evenly spaced by their logarithms, each once."""
    steps = int(np.floor(np.log10(max(largest, 1)) * per_decade)) + 1
    return np.unique(np.rint(10 ** (np.arange(steps) / per_decade)).astype(np.int64))


@dataclass(frozen=True, eq=False)
class Allan:
    """Overlapping Allan deviation at t averaging times, for c channels.

    factor: (t,), samples; tau: (t,), s; deviation, lower, upper: (t, c), U, with the 1-sigma
    confidence interval; degrees: (t, c), equivalent degrees of freedom of deviation²; terms:
    (t,), differences that were averaged; stretches: (t,), that contributed.
    """

    factor: Integers
    tau: Array
    deviation: Array
    lower: Array
    upper: Array
    degrees: Array
    terms: Integers
    stretches: Integers


class AllanSums:
    """Sums of squared differences, from consecutive pieces of one stretch after the other.

    `add` takes the next piece of a stretch, `end` ends it, `result` gives the deviations. Memory:
    for every channel 4 × 8 byte per sample of the longest average, at most 2 × 32 MB.
    """

    def __init__(self, channels: int, factors: Integers | None = None) -> None:
        """`channels`: c; `factors`: of the averaging times, ascending, by default every scale."""
        chosen = factors_up_to(10**9) if factors is None else np.asarray(factors, np.int64)
        # An average that starts at every STRIDE-th sample has a multiple of it as its length.
        long = chosen > MAX_EXACT_FACTOR
        chosen = np.where(long, chosen // STRIDE * STRIDE, chosen)
        self.factors = np.unique(chosen)
        self.channels = channels
        self._squares = np.zeros((len(self.factors), channels))
        self._terms = np.zeros(len(self.factors), np.int64)
        self._lengths: list[int] = []
        self._start()

    def _start(self) -> None:
        exact = self.factors[self.factors <= MAX_EXACT_FACTOR]
        coarse = self.factors[self.factors > MAX_EXACT_FACTOR] // STRIDE
        self._fine = _Differences(self.channels, exact)
        self._coarse = _Differences(self.channels, coarse)
        self._mean: Array | None = None
        self._left = np.zeros((0, self.channels))
        self._length = 0

    def add(self, piece: Array) -> None:
        """The next samples of the stretch, (n, c), at a regular interval, none missing."""
        if not len(piece):
            return
        if self._mean is None:  # a constant is lost in the differences, but not its rounding
            self._mean = np.mean(piece, axis=0)
        level = np.asarray(piece, np.float64) - self._mean
        self._length += len(level)
        self._fine.add(level)
        if len(self._coarse.factors):
            joined = np.concatenate([self._left, level])
            whole = len(joined) // STRIDE * STRIDE
            self._coarse.add(joined[:whole].reshape(-1, STRIDE, self.channels).sum(axis=1))
            self._left = joined[whole:]

    def end(self) -> None:
        """The stretch ends: the next piece belongs to another one."""
        if self._length:
            squares = np.concatenate([self._fine.squares, self._coarse.squares])
            terms = np.concatenate([self._fine.terms(), self._coarse.terms()])
            used = self.factors <= MAX_SHARE * self._length
            self._squares[used] += squares[used]
            self._terms[used] += terms[used]
            self._lengths.append(self._length)
        self._start()

    def result(self, interval: float, models: Sequence[NoiseModel] | None = None) -> Allan:
        """The deviations of all stretches that have ended.

        Parameters
        ----------
        interval : s, between samples
        models : of the noise of each channel, for the degrees of freedom; without them the kind of
            noise at each averaging time is taken from the slope of the deviation there
        """
        used = self._terms > 0
        factor, terms = self.factors[used], self._terms[used]
        squares = self._squares[used] / terms[:, None] / 2
        deviation = np.sqrt(squares) / factor[:, None]
        lengths = np.array(self._lengths, np.int64)
        degrees = np.empty_like(deviation)
        known: dict[tuple[int, NoiseModel], float] = {}
        for channel in range(self.channels):
            model = models[channel] if models is not None else None
            kinds = [model] * len(factor) if model else _kinds(factor, deviation[:, channel])
            for i, (m, kind) in enumerate(zip(factor.tolist(), kinds, strict=True)):
                if (m, kind) not in known:
                    known[m, kind] = pooled_degrees(m, lengths, kind, interval)
                degrees[i, channel] = known[m, kind]
        chosen = MAX_SHARE * lengths[:, None] >= factor
        return Allan(
            factor,
            np.asarray(factor * interval, np.float64),
            deviation,
            deviation * np.sqrt(degrees / chi2_isf(ONE_SIGMA, degrees)),
            deviation * np.sqrt(degrees / chi2_isf(1 - ONE_SIGMA, degrees)),
            degrees,
            terms,
            chosen.sum(axis=0),
        )


@dataclass
class _Differences:
    """Sums of squared second differences of the running sum of one stretch, any number of pieces.

    The running sums (c, ·) of the latest two averages are kept, and as many more before they are
    moved to the front.
    """

    channels: int
    factors: Integers
    squares: Array = field(init=False)

    def __post_init__(self) -> None:
        self.squares = np.zeros((len(self.factors), self.channels))
        self._sums = np.zeros((self.channels, 4 * BLOCK))
        self._filled = 1  # the running sum before the first sample is 0
        self._forgotten = 0

    def terms(self) -> Integers:
        """Differences of each factor so far."""
        return np.maximum(self._forgotten + self._filled - 2 * self.factors, 0)

    def add(self, values: Array) -> None:
        if not len(self.factors):
            return
        for start in range(0, len(values), BLOCK):
            block = values[start : start + BLOCK]
            if self._filled + len(block) > self._sums.shape[1]:
                self._make_room()
            after = self._filled + len(block)
            last = self._sums[:, self._filled - 1]
            sums = self._sums[:, self._filled : after]
            np.cumsum(block.T, axis=1, out=sums)
            sums += last[:, None]
            _square(self._sums, self._filled, after, self.factors, self.squares)
            self._filled = after

    def _make_room(self) -> None:
        needed = 2 * int(self.factors[-1]) + 1
        kept = min(self._filled, needed)
        capacity = self._sums.shape[1]
        if kept + BLOCK > capacity // 2:
            capacity = min(2 * capacity, 2 * needed + 2 * BLOCK)
        room = np.empty((self.channels, capacity))
        room[:, :kept] = self._sums[:, self._filled - kept : self._filled]
        self._forgotten += self._filled - kept
        self._sums, self._filled = room, kept


def _square(sums: Array, first: int, after: int, factors: Integers, squares: Array) -> None:
    """Add the squares of x(i) − 2 x(i − m) + x(i − 2m) for i from first to after.

    In numpy, for a compiled loop takes longer to load than most recordings to be differenced.
    """
    workspace = np.empty((2, after - first))
    for j, m in enumerate(factors.tolist()):
        start = max(first, 2 * m)
        if start >= after:
            break  # factors ascend
        rise, fall = workspace[:, : after - start]
        for channel, x in enumerate(sums):
            before = x[start - m : after - m]
            np.subtract(x[start:after], before, out=rise)
            np.subtract(x[start - 2 * m : after - 2 * m], before, out=fall)
            rise += fall
            squares[j, channel] += rise @ rise


def pooled_degrees(
    factor: int, lengths: Integers, model: NoiseModel, interval: float = 1.0
) -> float:
    """Equivalent degrees of freedom of the pooled Allan variance of stretches.

    Parameters
    ----------
    factor : m, samples
    lengths : (s,), samples of every stretch; the short ones do not count
    model : of the noise, its ramp aside
    interval : s, between samples
    """
    long = lengths[factor <= MAX_SHARE * lengths]
    lengths, times = np.unique(long, return_counts=True)
    terms = lengths - 2.0 * factor + 1
    lags, squares, peaks = _squared_correlations(factor, int(terms.max()), model, interval)
    # Of every two of the differences of a stretch; of both signs of the lag.
    products = np.maximum(terms[:, None] - lags, 0.0) * squares
    sums = np.sum((products[:, 1:] + products[:, :-1]) * np.diff(lags), axis=1)
    # Where steps of the lag are single samples, this is the sum itself; else one lag has no width.
    at = factor * np.arange(3)
    sums += np.maximum(terms[:, None] - at, 0.0) @ (peaks * [1, 2, 2])
    # The variance of a mean of M terms is 2/M² of the sum; weights are the numbers of terms.
    return float(np.sum(times * terms) ** 2 / np.sum(times * sums))


def _squared_correlations(
    factor: int, terms: int, model: NoiseModel, interval: float
) -> tuple[Array, Array, Array]:
    """Of two differences of a stretch: lags (l,), the smooth part of the squares (l,), and peaks.

    Rounding correlates differences at lags of 0, 1, and 2 averages only: peaks, (3,).
    """
    step = max(factor // LAGS_PER_TAU, 1)
    last = max(min(terms - 1, MAX_LAG_TAUS * factor), 1)
    lags = np.append(np.arange(0, last, step), last).astype(np.float64)
    if not model.variances.any():
        model = BY_EXPONENT[0]
    # In units of the average, so that its powers lose no digits.
    weights = model.variances * (factor * interval) ** np.array([0.0, 1.0, 2.0, 3.0])
    quantisation, weights[0] = weights[0], 0.0

    def smooth(lag: Array) -> Array:
        shifts = np.add.outer(np.array([0, 1, -1, 2, -2]), lag / factor)
        across = np.tensordot(weights, angle_autocovariance(shifts), 1)
        return np.asarray(np.array([6, -4, -4, 1, 1]) @ across)

    own = smooth(factor * np.arange(3.0))
    with_peaks = own + quantisation * np.array([6.0, -4.0, 1.0])
    variance = with_peaks[0]
    squares = (smooth(lags) / variance) ** 2
    return lags, squares, (with_peaks**2 - own**2) / variance**2


def _kinds(factor: Integers, deviation: Array) -> list[NoiseModel]:
    """The kind of noise at each averaging time by the slope of log σ² over log τ around it."""
    if len(factor) < 2:
        return [BY_EXPONENT[0]] * len(factor)
    logs = np.log(np.maximum(deviation, np.finfo(float).tiny)) * 2
    slope = np.gradient(logs, np.log(factor.astype(np.float64)))
    smooth = np.convolve(np.pad(slope, 2, mode="edge"), np.full(5, 0.2), mode="valid")
    # σ² ~ τ^μ: μ = −2, −1, 0, 1 for densities f², f⁰, f⁻¹, f⁻².
    nearest = np.clip(np.rint(smooth), -2, 1).astype(int)
    return [BY_EXPONENT[{-2: 2, -1: 0, 0: -1, 1: -2}[int(mu)]] for mu in nearest]
