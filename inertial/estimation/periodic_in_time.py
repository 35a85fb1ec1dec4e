"""Oscillations in residuals: spectral lines, pooled over records, periodic in time or in angle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import pinvh
from scipy.optimize import minimize_scalar

from inertial.arrays import Array, Booleans
from inertial.estimation.probability import chi2_isf, chi2_logsf
from inertial.estimation.spectrum import WHITE, NoiseShape

MIN_SAMPLES = 64  # in which a line can be distinguished from noise
OVERSAMPLING = 2  # the search steps by half a bin, so that no line lies between two
MAX_LEAKAGE = 0.05  # of the amplitude of a removed line, one bin away from it
MIN_TAPERED = 0.4  # least ratio of peak powers, less the noise, with and without a Hann window
MIN_LOUD_BINS = 12  # behind a filter, that tell the level of the noise
BESIDE_BINS = 3  # on each side, that show how loud filtered noise is; a line fills one or two
HANN_NOISE = 1.5  # its equivalent noise bandwidth, bins (Harris 1978)
MAX_SIDELOBE = 8.0  # power a bin away from what is below, to its peak: 1/π² of a sine, 8 of a decay


@dataclass(frozen=True)
class Line:
    """One oscillation A sin(2πf t + φ) of one channel.

    `frequency` and `sigma_frequency`: Hz; `amplitude` and `sigma_amplitude`: unit of the
    record; `p_value`: probability of so high a peak anywhere in the spectrum by noise alone.
    """

    frequency: float
    sigma_frequency: float
    amplitude: float
    sigma_amplitude: float
    p_value: float


@dataclass(frozen=True)
class Taken:
    """A line that was removed from a record: Hz, and the amplitude that it had."""

    frequency: float
    amplitude: float

    def leaks(self, frequency: Array, seconds: float) -> Array:
        """Largest amplitude of its remainder at other frequencies, in a record of so long."""
        bins = np.abs(frequency - self.frequency) * seconds
        return np.asarray(MAX_LEAKAGE * self.amplitude / np.maximum(bins, MAX_LEAKAGE))


def strongest(
    record: Array,
    rate: float,
    lowest: float,
    taken: Sequence[Taken] = (),
    shape: NoiseShape = WHITE,
) -> Line | None:
    """The most significant line of a record.

    The periodogram of noise is exponentially distributed about its level, which is estimated from
    its median in units of the shape of the noise; the p-value is corrected for the search over all
    bins. A sidelobe of what is below the search is no line: in the record tapered by a Hann window
    a line is as high, and a sidelobe is not (Harris, Proc. IEEE 66 (1978) 51).

    Parameters
    ----------
    record : (n,), samples without gaps
    rate : Hz, samples per second
    lowest : Hz, lower end of the search
    taken : lines that were removed before; their remainders are not detected again
    shape : of the noise
    """
    n = len(record)
    if n < MIN_SAMPLES:
        return None
    frequency, density = _spectrum(record, rate)
    inside = (frequency >= lowest) & (frequency < rate / 2)
    noise = shape.at(frequency) ** 2
    leakage = _leakage(frequency, density, lowest, n / rate, frequency) / noise
    density = density / noise
    loud = inside & shape.loud(frequency)
    level = float(np.median(density[loud]) / np.log(2)) if loud.any() else 0.0
    if level <= 0 or loud.sum() < min(MIN_LOUD_BINS * OVERSAMPLING, inside.sum()):
        return None
    tapered = _spectrum(record, rate, tapered=True)[1] / noise
    candidates = inside & _not_sidelobes(density, tapered, level, leakage)
    for line in taken:
        leaks = n / (2 * rate) * line.leaks(frequency, n / rate) ** 2
        candidates &= density > leaks / noise
    if not candidates.any():
        return None
    peak = int(np.argmax(np.where(candidates, density, 0.0)))
    trials = float(inside.sum())
    p_value = float(-np.expm1(trials * np.log1p(-np.exp(-density[peak] / level))))
    refined = _refined(record, rate, float(frequency[peak]))
    return line_at(record, rate, lowest, refined, p_value, shape)


def line_at(
    record: Array,
    rate: float,
    lowest: float,
    frequency: float,
    p_value: float,
    shape: NoiseShape = WHITE,
) -> Line:
    """The line of one frequency; the noise, of a `shape`, is estimated from `lowest` on, Hz."""
    n = len(record)
    # The line itself leaks into all bins, so the noise is estimated without it.
    split = without_line(record, rate, frequency)
    bins, noise = _spectrum(split.less(split.amplitude), rate)
    inside = (bins >= lowest) & (bins < rate / 2) & shape.loud(bins)
    inside = inside if inside.any() else (bins > 0) & shape.loud(bins)
    flat = noise[inside] / shape.at(bins[inside]) ** 2
    per_sample = float(np.sqrt(np.median(flat) / np.log(2) * rate / 2) * shape.at(frequency))
    # Rife & Boorstyn, IEEE Trans. Inform. Theory 20 (1974) 591: bounds of both.
    sigma_frequency = np.sqrt(6) * per_sample * rate / (np.pi * split.amplitude * n**1.5)
    sigma_amplitude = per_sample * np.sqrt(2 / n)
    return Line(frequency, float(sigma_frequency), split.amplitude, float(sigma_amplitude), p_value)


def _spectrum(record: Array, rate: float, *, tapered: bool = False) -> tuple[Array, Array]:
    """Frequencies, Hz, and power density of one side; of a line the same where it is tapered."""
    from scipy.fft import rfft, rfftfreq  # here, as a stage without turns needs none

    n, count = len(record), OVERSAMPLING * len(record)  # which is even
    place = np.arange(n) - (n - 1) / 2
    level = record - record.mean()
    level = level - place * (place @ level / (place @ place))
    transformed = rfft(level * _taper(n) if tapered else level, count)
    density = np.abs(transformed) ** 2 / (rate * n)
    density[1:-1] *= 2  # of both signs of a frequency
    return rfftfreq(count, 1 / rate), density


def _louder(power: Array, degrees: int) -> Array:
    """By how many times noise of a shape is louder beside each frequency than by the shape, (m,).

    Between the zeros of a moving average it is, for its shape is known by cells that may be as wide
    as they are apart. By the median of χ² of so many `degrees`; 1 at least.
    """
    side = BESIDE_BINS * OVERSAMPLING
    about = np.pad(power, side, mode="reflect" if len(power) > side else "edge")
    beside = np.median(np.lib.stride_tricks.sliding_window_view(about, 2 * side + 1), axis=1)
    return np.asarray(np.maximum(beside / chi2_isf(0.5, degrees), 1.0))


def _not_sidelobes(
    density: Array, tapered: Array, noise: Array | float, leakage: Array
) -> Booleans:
    """Where a peak would be no sidelobe of what is below the search, (m,).

    It is higher than such `leakage` may be, or as high in the tapered record; an oscillation that
    decays at once is not. `noise`: the mean of the density without any line.
    """
    width = 2 * OVERSAMPLING + 1
    about = np.pad(density, OVERSAMPLING, mode="edge")
    highest = np.lib.stride_tricks.sliding_window_view(about, width).max(axis=1)
    as_high = tapered - HANN_NOISE * noise > MIN_TAPERED * (highest - noise)
    return np.asarray(as_high | (density > leakage))


def _leakage(bins: Array, density: Array, lowest: float, seconds: float, at: Array) -> Array:
    """The largest density that what is below the search may have `at` frequencies, (m,), Hz.

    `bins`, `density`: the spectrum of the record, which lasts for `seconds`.
    """
    peak = int(np.argmax(np.where(bins < lowest, density, 0.0)))
    apart = np.maximum((at - bins[peak]) * seconds, 1.0)
    return np.asarray(MAX_SIDELOBE * density[peak] / apart**2)


def _taper(count: int) -> Array:
    """A Hann window whose mean is one, (n,)."""
    return np.asarray(1 - np.cos(2 * np.pi * (np.arange(count) + 0.5) / count))


def _refined(record: Array, rate: float, near: float) -> float:
    """The frequency within a bin of `near` with the smallest residuals, Hz."""
    width = rate / len(record)

    def residual_squares(frequency: float) -> float:
        columns, parts = _fitted(record, rate, frequency)
        return float(np.sum((record - columns @ parts) ** 2))

    bounds = (max(near - width, 0.0), near + width)
    return float(
        minimize_scalar(
            residual_squares, bounds=bounds, method="bounded", options={"xatol": 1e-6 * width}
        ).x
    )


@dataclass(frozen=True)
class Split:
    """A record without mean and slope, (n,), and the line of one frequency in it."""

    record: Array
    amplitude: float
    shape: Array  # (n,), the line at amplitude 1

    def less(self, amplitude: float) -> Array:
        """The record less the line at another amplitude, its phase kept."""
        return np.asarray(self.record - amplitude * self.shape)


def without_line(record: Array, rate: float, frequency: float) -> Split:
    """Split a record, sampled at `rate` Hz, into its line at `frequency` Hz and the remainder."""
    columns, parts = _fitted(record, rate, frequency)
    level = np.asarray(record - columns[:, 2:] @ parts[2:])
    line = columns[:, :2] @ parts[:2]
    amplitude = float(np.linalg.norm(parts[:2]))
    return Split(level, amplitude, line / amplitude if amplitude else line)


def phasor(record: Array, rate: float, frequency: float) -> complex:
    """c of Re c exp(2πi f t), t from the first sample, of the line of one frequency."""
    sine, cosine = _fitted(record, rate, frequency)[1][:2]
    return complex(cosine, -sine)


def _fitted(record: Array, rate: float, frequency: float) -> tuple[Array, Array]:
    """Sine, cosine, mean and slope by least squares: columns (n, 4) and their parts (4,)."""
    time = np.arange(len(record)) / rate
    phase = 2 * np.pi * frequency * time
    slope = 2 * time / time[-1] - 1
    columns = np.column_stack([np.sin(phase), np.cos(phase), np.ones_like(time), slope])
    return columns, np.asarray(pinvh(columns.T @ columns) @ (columns.T @ record))


def pooled(
    records: Sequence[Array],
    rates: Sequence[float],
    lowest: float,
    shape: NoiseShape = WHITE,
) -> tuple[Array, Array, Array]:
    """Search for a line at one frequency in several records, each with a phase of its own.

    The sum of the periodograms of k records of noise, each over its level, has the chi-squared
    distribution with 2k degrees of freedom. So a line that is significant in no single
    record may be so in all common. The p-value is not corrected for the search.

    Returns frequencies, Hz, drop of chi-squared, and natural logarithm of its p-value, (m,) each;
    0 at sidelobes of what is below `lowest`, as in `strongest`. None where nearly all is faint:
    behind a filter that leaves next to nothing there is no level to judge a line by.

    Parameters
    ----------
    records : each (n,), samples without gaps; rates : Hz, samples per second
    lowest : Hz, below which nothing is looked for; shape : of the noise
    """
    from scipy.signal import czt  # here, for it loads half of scipy

    longest = max(len(record) / rate for record, rate in zip(records, rates, strict=True))
    step = 1 / (OVERSAMPLING * longest)
    frequency = np.arange(lowest, min(rates) / 2, step)
    drop, tapered, leakage = np.zeros((3, len(frequency)))
    noise, loud = shape.at(frequency) ** 2, shape.loud(frequency)
    if loud.sum() < min(MIN_LOUD_BINS * OVERSAMPLING, len(loud)):
        return np.zeros(0), np.zeros(0), np.zeros(0)
    for record, rate in zip(records, rates, strict=True):
        place = np.arange(len(record))
        level = record - np.polyval(np.polyfit(place, record, 1), place)
        ratio, start = np.exp(np.array([-2j * np.pi * step, 2j * np.pi * lowest]) / rate)
        both = np.array([level, level * _taper(len(record))])
        power, own = np.abs(czt(both, len(frequency), ratio, start)) ** 2 / noise
        unit = 2 * np.log(2) / np.median(power[loud])
        drop += power * unit
        tapered += own * unit
        seconds = len(record) / rate
        leaks = _leakage(*_spectrum(record, rate), lowest, seconds, frequency) / noise
        leakage += leaks * rate * len(record) / 2 * unit
    degrees = 2 * len(records)
    if shape is not WHITE:
        drop, tapered, leakage = np.array([drop, tapered, leakage]) / _louder(drop, degrees)
    log_p = chi2_logsf(drop, degrees)
    lines = _not_sidelobes(drop, tapered, degrees, degrees + leakage)
    return frequency, drop, np.where(lines, log_p, 0.0)


def score(drops: Array) -> Array:
    """Natural logarithm of how much likelier a line is than none, for drops of chi-squared by it.

    Half of the drop, less the logarithm of prior over posterior widths of amplitude and phase: at a
    signal-to-noise ratio R, whose square is the drop, the posterior of a phase takes 1/(√(2π) R) of
    its range, and an amplitude that was known to be no larger than twice the estimate √(2π)/(2 R).
    Where a turn fits better without the line, it is absent.
    """
    return np.asarray(np.maximum(drops / 2 - np.log(np.maximum(2 * drops, 1.0)), 0.0))


def score_of_own_frequency(drops: Array) -> Array:
    """The same for a frequency that is known to a bin: its sigma is about 1/R of that."""
    return np.asarray(score(drops) - np.log(np.maximum(np.sqrt(drops), 1.0)))
