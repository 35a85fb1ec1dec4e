"""White noise of a record from its spectrum, its shape, and deviations of a steady rate."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.fft import rfft

from inertial.arrays import Array, Booleans
from inertial.estimation.probability import chi2_sf

MIN_BAND_BINS = 12  # of a shorter record the band extends as far as that
CHANGED_P_VALUE = 1e-4  # of a level of a piece, from which the noise changes between pieces
BINS_PER_INDEPENDENT_BIN = 1.5  # of a Hann window
FAINT = 0.2  # of the loudest noise of a record
PASSED = 0.5**0.5  # of the amplitude, at the corner of a filter
SETTLED = 12.0  # time constants, after which 10⁻⁵ of a step remain
STEADY_RUNS = 8  # per recorded steady part: runs whose scatter is known to 27 %


@dataclass(frozen=True)
class NoiseShape:
    """The amplitude of the noise by frequency, in any unit: (k,) each, Hz ascending.

    Where it is faint, what leaks from elsewhere is louder: it is no less than a share of the most.
    """

    frequency: Array
    amplitude: Array

    def at(self, frequency: Array | float) -> Array:
        """The amplitude at some frequencies, Hz."""
        return np.asarray(np.maximum(self._between(frequency), FAINT * self.amplitude.max()))

    @property
    def settling(self) -> float:
        """How long a filter that has this shape settles, s; 0 where it takes no upper part away."""
        passed = np.flatnonzero(self.amplitude >= PASSED * self.amplitude.max())
        if passed[-1] == len(self.amplitude) - 1:
            return 0.0
        return float(SETTLED / (2 * np.pi * self.frequency[passed[-1]]))

    def loud(self, frequency: Array) -> Booleans:
        """Where it is not faint, so that a record shows its level."""
        return np.asarray(self._between(frequency) >= FAINT * self.amplitude.max())

    def _between(self, frequency: Array | float) -> Array:
        return np.asarray(np.exp(np.interp(frequency, self.frequency, np.log(self.amplitude))))


WHITE = NoiseShape(np.ones(1), np.ones(1))


def band_levels(
    values: Array, rate: float, band: tuple[float, float], shape: NoiseShape = WHITE
) -> Array:
    """The periodogram of each channel within a band, as power density of both sides.

    In units of the square of the shape of the noise, without where that is faint.

    Parameters
    ----------
    values : (n, c), samples without gaps, in any unit U
    rate : Hz, samples per second
    band : Hz, from and to

    Returns
    -------
    (bins, c), U²/Hz; white noise of random walk N (U/√Hz) has the level N²
    """
    frequency, density = in_band(values, rate, band)
    loud = shape.loud(frequency)
    return np.asarray(density[loud] / shape.at(frequency[loud])[:, None] ** 2)


MAX_LINE_P_VALUE = 1e-4  # that noise alone has a line anywhere in a periodogram
LINE_CHANCES = 2.0  # of its floor to the median, where a filter takes from its upper part


def in_band(values: Array, rate: float, band: tuple[float, float]) -> tuple[Array, Array]:
    """The frequencies within a band, (bins,), Hz, and the periodogram there, as `band_levels`."""
    density = periodogram(detrended(values).T, rate).T
    frequency = np.arange(1, len(density) + 1) * rate / len(values)
    first = min(int(np.searchsorted(frequency, band[0])), max(len(frequency) - MIN_BAND_BINS, 1))
    after = int(np.searchsorted(frequency, band[1], side="right"))
    inside = slice(first, max(after, first + MIN_BAND_BINS))
    return frequency[inside].copy(), density[inside].copy()  # a view would keep all of them


def square_of_integral(values: Array, rate: float, above: float) -> Array:
    """The mean square of the integral of the lines of each column above a frequency, (c,), (U s)².

    A line is what stands out of the noise by more than chance, of all frequencies together. Its
    sum over samples is that of its two ends: A/(2 sin(πf/rate)) a sample, however long they are.

    values: (n, c), in any unit U; rate, above: Hz.
    """
    density = periodogram(detrended(values).T, rate)
    frequency = np.arange(1, density.shape[1] + 1) * rate / len(values)
    fast = frequency > above
    if not fast.any():
        return np.zeros(values.shape[1])
    density, frequency = density[:, fast], frequency[fast]
    floor = np.median(density, axis=1, keepdims=True) / np.log(2)
    line = density > LINE_CHANCES * np.log(density.shape[1] / MAX_LINE_P_VALUE) * floor
    of_sums = 2 * rate * np.sin(np.pi * frequency / rate)
    return np.asarray(np.sum(line * density / of_sums**2, axis=1) * 2 * rate / len(values))


def detrended(values: Array) -> Array:
    """Columns, (n, c), less their mean and slope."""
    time = np.arange(len(values)) - (len(values) - 1) / 2
    level = values - values.mean(axis=0)
    level -= np.outer(time, time @ level / (time @ time))
    return np.asarray(level)


def periodogram(values: Array, rate: float) -> Array:
    """The power density of both sides with a Hann window, without the first and the last bin.

    By the transform itself, for scipy.signal takes longer to load than most recordings to be
    transformed.

    Parameters
    ----------
    values : (..., n), less their means or lines, in any unit U
    rate : Hz, samples per second

    Returns
    -------
    (..., n // 2 - 1), U²/Hz, at the frequencies k rate / n from k = 1 on
    """
    window = _hann(values.shape[-1])
    amplitude = rfft(values * window)[..., 1:-1]
    return np.asarray((amplitude.real**2 + amplitude.imag**2) / (rate * (window @ window)))


@lru_cache(maxsize=4)
def _hann(samples: int) -> Array:
    return np.asarray(0.5 - 0.5 * np.cos(2 * np.pi * np.arange(samples) / samples))


def white_level(levels: Array) -> tuple[Array, Array]:
    """The white noise of each channel and its standard deviation, by the median of the band.

    An oscillation, which fills few bins, and a drift, which lies below the band, do not count.

    The median of n exponentially distributed bins is ln 2 of their mean for large n;
    for few bins as in Allen et al., Phys. Rev. D 85 (2012) 122006, appendix B.

    Parameters
    ----------
    levels : (bins, c), U²/Hz

    Returns
    -------
    random walk, U/√Hz, and its standard deviation, (c,) each
    """
    bins = len(levels)
    terms = 1 / np.arange(1, 2 * ((bins - 1) // 2) + 2)
    bias = float(np.sum(terms * np.where(np.arange(len(terms)) % 2, -1, 1)))
    white = np.sqrt(np.median(levels, axis=0) / bias)
    # The sample median m of an exponential has variance 1/n; half of it for the root.
    relative = 0.5 / np.log(2) / np.sqrt(max(bins / BINS_PER_INDEPENDENT_BIN, 1.0))
    return white, relative * white


def level_of_pieces(pieces: Sequence[Array], seconds: Sequence[float]) -> tuple[Array, Array]:
    """The white noise of a record in pieces and its standard deviation, see `white_level`.

    That of all bins together; but where the noise of a channel changes between the pieces, of which
    the median tells the half, the root of the mean of their squares.

    Parameters
    ----------
    pieces : (bins, c) each, U²/Hz
    seconds : duration of each piece

    Returns
    -------
    random walk, U/√Hz, and its standard deviation, (c,) each
    """
    white, sigma = white_level(np.concatenate(pieces))
    own, sigmas = np.array([white_level(piece) for piece in pieces]).swapaxes(0, 1)
    known, seen = sigmas > 0, white > 0
    degrees = np.divide(own, sigmas, out=np.zeros_like(own), where=known) ** 2 / 2
    ratio = np.divide(own, white, out=np.ones_like(own), where=seen)
    above = chi2_sf(degrees * ratio**2, degrees)
    chance = 2 * np.minimum(above, 1 - above).min(axis=0) * len(pieces)
    mean = np.sqrt(np.average(own**2, axis=0, weights=seconds))
    share = np.array(seconds)[:, None] / np.sum(seconds)
    of_mean = np.sqrt(np.sum((share * own * sigmas) ** 2, axis=0))
    of_mean = np.divide(of_mean, mean, out=np.zeros_like(mean), where=mean > 0)
    changes = chance < CHANGED_P_VALUE
    return np.where(changes, mean, white), np.where(changes, of_mean, sigma)


def rate_deviation(
    rate: Array, seconds: Array, elapsed: Array, before: Booleans, missing: float, density: float
) -> float:
    """Sigma of the mean rate of the table in a gap about that of the recorded parts, rad/s.

    The larger of two, each without the contribution of white noise. First, half of the difference
    between the rates before and after: wherever in the gap the rate has changed, its mean is not
    farther off. Second, the scatter of means over runs of the length of the gap, or of an eighth of
    the recorded part if that is shorter: that a longer run averages more is not assumed.

    Parameters
    ----------
    rate, seconds, elapsed : (k,), rad/s and s, of the steady blocks; elapsed at their middles
    before : (k,), which of them precede the longest gap
    missing : s, duration of that gap
    density : rad/√s, white noise along the axis
    """
    whole = float(seconds.sum())
    difference = 0.0
    if before.any() and not before.all():
        durations = np.array([seconds[part].sum() for part in (before, ~before)])
        means = np.array([rate[part] @ seconds[part] for part in (before, ~before)]) / durations
        excess = (means[1] - means[0]) ** 2 - density**2 * np.sum(1 / durations)
        difference = float(np.sqrt(max(excess, 0.0))) / 2

    length = max(min(missing, whole / STEADY_RUNS), float(np.median(seconds)))
    run = ((elapsed - elapsed[0]) / length).astype(np.int64)
    durations = np.bincount(run, seconds)
    full = durations > length / 2  # a run that a gap cuts is shorter than the others
    scatter = 0.0
    if full.sum() > 1:
        means = np.bincount(run, rate * seconds)[full] / durations[full]
        excess_variance = float(np.var(means, ddof=1) - density**2 * np.mean(1 / durations[full]))
        scatter = float(np.sqrt(max(excess_variance, 0.0)))
    return max(difference, scatter)


# ---- How the noise of a record goes with the frequency
#
# A filter of the sensor, or a vibration, colours the noise. A line is judged by the noise about its
# own frequency: by that of the whole band, of which a filter takes the upper part, every wave of
# the noise below would be a line.

CELL_BINS = 8.0  # of each record in a cell of the spectrum
LOBE_BINS = 2  # to each side, that a line fills in a spectrum with a Hann window
BESIDE_BINS = 12  # on each side, above whose median a line stands out
CELL_RATIO = 1.1  # of the ends of a cell, at least
MAX_WIDER = 1.5  # of the bins of records that tell the shape, times those of the usual one
MAX_CHANCE = 1e-4  # that white noise counts as coloured
MEDIAN_VARIANCE = 1 / np.log(2) ** 2  # relative, times n, of the median of n exponential bins


def noise_shape(records: Sequence[Array], rate: float, lowest: float) -> NoiseShape:
    """The shape that records have in common; `WHITE` where they differ from that by chance alone.

    By the median in each cell of the spectrum, without the bins of lines: at low frequencies one
    fills half of a cell.

    Parameters
    ----------
    records : each (n,), samples without gaps; their levels may differ
    rate : Hz, samples per second; lowest : Hz, below which the noise may be drift
    """
    frequencies, levels = [], []
    for record in records:
        density = periodogram(detrended(record[:, None]).T, rate)[0]
        frequency = np.arange(1, len(density) + 1) * rate / len(record)
        frequencies.append(frequency[frequency >= lowest])
        levels.append(density[frequency >= lowest])
    return shape_of(frequencies, levels)


def shape_of(frequencies: Sequence[Array], levels: Sequence[Array]) -> NoiseShape:
    """The same by the periodogram of each record: frequencies, Hz, and levels, (bins,) each.

    By the longer records, which have half of the bins at least: the bins of a short one are wide.
    """
    split = [(f, level, _line_bins(level)) for f, level in zip(frequencies, levels, strict=True)]
    there = [(f[~line], level[~line]) for f, level, line in split if level[~line].any()]
    bin_width = _usual_bin_width([frequency for frequency, _level in there])
    there = [one for one in there if _bin_width(one[0]) <= MAX_WIDER * bin_width]
    edges = _cells([frequency for frequency, _level in there], bin_width)
    if len(edges) < 3:
        return WHITE
    frequency = np.concatenate([frequency for frequency, _level in there])
    level = np.concatenate([level / np.median(level[level > 0]) for _frequency, level in there])
    order = np.argsort(np.searchsorted(edges[1:-1], frequency, side="right"), kind="stable")
    counts = np.bincount(np.searchsorted(edges[1:-1], frequency, side="right"))
    cells = np.split(level[order], np.cumsum(counts)[:-1])
    medians = np.array([np.median(cell) if len(cell) else 0.0 for cell in cells])
    known = medians > 0
    found, count = np.log(medians[known]), counts[known] / BINS_PER_INDEPENDENT_BIN
    weight = count / MEDIAN_VARIANCE
    apart = float(weight @ (found - np.average(found, weights=weight)) ** 2)
    if chi2_sf(apart, len(found) - 1) > MAX_CHANCE:
        return WHITE
    about = np.pad(found, 1, mode="reflect", reflect_type="odd")
    # Between two zeros of a moving average the noise is as loud as it is.
    smooth = np.maximum(np.convolve(about, (0.25, 0.5, 0.25), "valid"), found)
    middle = (edges[1:] + edges[:-1]) / 2
    return NoiseShape(middle[: len(known)][known], np.exp(smooth / 2))


def _line_bins(level: Array) -> Booleans:
    """Which bins of the periodogram of a record a line fills, (m,).

    One that is higher than noise alone has any, by the larger median of the bins before it and
    after it: on the slope of a filter or of a drift the one, beside another line the other.
    """
    pieces = len(level) // BESIDE_BINS
    if pieces < 2:
        return np.zeros(len(level), bool)
    medians = np.median(level[: pieces * BESIDE_BINS].reshape(pieces, BESIDE_BINS), axis=1)
    about = np.pad(medians, 1, mode="edge")
    piece = np.minimum(np.arange(len(level)) // BESIDE_BINS, pieces - 1)
    noise = np.maximum(about[:-2], about[2:])[piece] / np.log(2)
    high = level > LINE_CHANCES * np.log(len(level)) * noise
    return np.asarray(np.convolve(high, np.ones(2 * LOBE_BINS + 1), "same") > 0)


def _usual_bin_width(frequencies: Sequence[Array]) -> float:
    """Of the records that, from the longest on, have half of the bins, Hz; 0 without any."""
    longest = sorted((one for one in frequencies if len(one) > 1), key=_bin_width)
    bins = np.cumsum([len(one) for one in longest])
    return _bin_width(longest[int(np.searchsorted(bins, bins[-1] / 2))]) if longest else 0.0


def _bin_width(frequency: Array) -> float:
    """Of a record, Hz; infinite of one that has a single bin."""
    return float(frequency[1] - frequency[0]) if len(frequency) > 1 else np.inf


def _cells(frequencies: Sequence[Array], bin_width: float) -> Array:
    """The ends of the cells, Hz, in each of which a record of this bin width has bins enough."""
    if not frequencies:
        return np.zeros(0)
    edges = [float(min(frequency[0] for frequency in frequencies))]
    highest = float(max(frequency[-1] for frequency in frequencies))
    while True:
        following = max(edges[-1] * CELL_RATIO, edges[-1] + CELL_BINS * bin_width)
        if following + CELL_BINS * bin_width / 2 > highest:
            return np.array([*edges, highest])
        edges.append(following)
