"""Oscillations in residuals: spectral lines, pooled over records, periodic in time or in angle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from inertial.estimation.probability import chi2_logsf

# ---- Oscillations in residuals: lines that stand out of the noise of a spectrum.

Array = NDArray[np.float64]

FEWEST = 64  # samples in which a line can be told from noise
OVERSAMPLED = 2  # the search steps by half a bin, so that no line falls between two
LEAKS = 0.05  # of a line that is taken out may be left a bin beside it: it is never quite even


@dataclass(frozen=True)
class Line:
    """One oscillation A sin(2πf t + φ) of one channel.

    `frequency` and `sigma_frequency`: Hz; `amplitude` and `sigma_amplitude`: unit of the
    record; `p_value`: chance of so high a peak anywhere in the spectrum, by noise alone.
    """

    frequency: float
    sigma_frequency: float
    amplitude: float
    sigma_amplitude: float
    p_value: float


@dataclass(frozen=True)
class Taken:
    """A line that was taken out of a record: Hz, and its amplitude there."""

    frequency: float
    amplitude: float

    def leaks(self, frequency: Array, seconds: float) -> Array:
        """The amplitude that may be left of it at other frequencies, in a record of so long."""
        bins = np.abs(frequency - self.frequency) * seconds
        return np.asarray(LEAKS * self.amplitude / np.maximum(bins, LEAKS))


def strongest(
    record: Array, rate: float, lowest: float, taken: Sequence[Taken] = ()
) -> Line | None:
    """The line of a record that stands out most.

    The periodogram of white noise is exponentially distributed about its level, which is
    had from its median; the search over all bins is paid for.

    Parameters
    ----------
    record : (n,), samples without gaps
    rate : Hz, samples per second
    lowest : Hz, below which nothing is looked for
    taken : lines that were taken out of it; what they may have left is none
    """
    n = len(record)
    if n < FEWEST:
        return None
    frequency, density = _spectrum(record, rate)
    inside = (frequency >= lowest) & (frequency < rate / 2)
    level = float(np.median(density[inside]) / np.log(2)) if inside.any() else 0.0
    if level <= 0:
        return None
    stands = inside.copy()
    for one in taken:
        stands &= density > n / (2 * rate) * one.leaks(frequency, n / rate) ** 2
    if not stands.any():
        return None
    peak = int(np.argmax(np.where(stands, density, 0.0)))
    trials = float(inside.sum())
    p_value = float(-np.expm1(trials * np.log1p(-np.exp(-density[peak] / level))))
    return near(record, rate, lowest, float(frequency[peak]), p_value)


def near(record: Array, rate: float, lowest: float, frequency: float, p_value: float) -> Line:
    """The line within a bin of a frequency, as `line_at` has it."""
    return line_at(record, rate, lowest, _refined(record, rate, frequency), p_value)


def line_at(record: Array, rate: float, lowest: float, frequency: float, p_value: float) -> Line:
    """The line of one frequency; the noise is read from `lowest` on, Hz."""
    n = len(record)
    # The line itself leaks into all bins, so the noise is read without it.
    split = without_line(record, rate, frequency)
    bins, left = _spectrum(split.less(split.amplitude), rate)
    inside = (bins >= lowest) & (bins < rate / 2)
    per_sample = float(np.sqrt(np.median(left[inside]) / np.log(2) * rate / 2))
    # Rife & Boorstyn, IEEE Trans. Inform. Theory 20 (1974) 591: bounds of both.
    sigma_frequency = np.sqrt(6) * per_sample * rate / (np.pi * split.amplitude * n**1.5)
    sigma_amplitude = per_sample * np.sqrt(2 / n)
    return Line(frequency, float(sigma_frequency), split.amplitude, float(sigma_amplitude), p_value)


def _spectrum(record: Array, rate: float) -> tuple[Array, Array]:
    """Frequencies, Hz, and power density of one side."""
    from scipy.signal import periodogram  # here, for it loads half of scipy

    # The stubs do not know that the trend may be a line.
    frequency, density = periodogram(  # type: ignore[call-overload]
        record, rate, "boxcar", nfft=OVERSAMPLED * len(record), detrend="linear"
    )
    return frequency, density


def _refined(record: Array, rate: float, near: float) -> float:
    """The frequency within a bin of `near` that leaves the least of the record, Hz."""
    width = rate / len(record)

    def left(frequency: float) -> float:
        columns, parts = _fitted(record, rate, frequency)
        return float(np.sum((record - columns @ parts) ** 2))

    bounds = (max(near - width, 0.0), near + width)
    return float(
        minimize_scalar(left, bounds=bounds, method="bounded", options={"xatol": 1e-6 * width}).x
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
    """Part a record, sampled at `rate` Hz, from its line at `frequency` Hz."""
    columns, parts = _fitted(record, rate, frequency)
    level = np.asarray(record - columns[:, 2:] @ parts[2:])
    line = columns[:, :2] @ parts[:2]
    amplitude = float(np.linalg.norm(parts[:2]))
    return Split(level, amplitude, line / amplitude if amplitude else line)


def energy(record: Array, rate: float, frequency: float) -> float:
    """By how much a line of one frequency lessens the sum of squares beside mean and slope."""
    columns, parts = _fitted(record, rate, frequency)
    slow = np.linalg.qr(columns[:, 2:])[0]
    level = record - slow @ (slow.T @ record)
    return float(level @ level - np.sum((record - columns @ parts) ** 2))


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
    inverse = np.linalg.pinv(columns.T @ columns, hermitian=True)
    return columns, np.asarray(inverse @ (columns.T @ record))


# ---- A line at one frequency in several records, each with a phase of its own.
#
# The sum of the periodograms of k records of white noise, each over its level, is distributed like
# chi-squared with 2k degrees of freedom. So a line that no record shows by itself may stand out of
# all together.


def pooled(
    records: Sequence[Array], rates: Sequence[float], lowest: float
) -> tuple[Array, Array, Array]:
    """Frequencies, Hz, drop of chi-squared, and natural logarithm of its chance, (m,) each.

    The search over all frequencies is not paid for.

    Parameters
    ----------
    records : each (n,), samples without gaps; rates : Hz, samples per second
    lowest : Hz, below which nothing is looked for
    """
    from scipy.signal import czt  # here, for it loads half of scipy

    longest = max(len(one) / rate for one, rate in zip(records, rates, strict=True))
    step = 1 / (OVERSAMPLED * longest)
    frequency = np.arange(lowest, min(rates) / 2, step)
    drop = np.zeros_like(frequency)
    for record, rate in zip(records, rates, strict=True):
        place = np.arange(len(record))
        level = record - np.polyval(np.polyfit(place, record, 1), place)
        summed = czt(
            level,
            len(frequency),
            np.exp(-2j * np.pi * step / rate),
            np.exp(2j * np.pi * lowest / rate),
        )
        power = np.abs(summed) ** 2
        drop += power * 2 * np.log(2) / np.median(power)
    degrees = 2 * len(records)
    return frequency, drop, chi2_logsf(drop, degrees)


# ---- Whether an oscillation is bound to time or to the table's angle.
#
# In time it has in each turn a phase of its own, for nothing ties one turn to the next; frequency
# and amplitude are the same in all turns, or not. Against the angle it has an order and one a and
# b for all turns. Each is scored by half the drop of chi-squared, less what its free parameters
# and its search cost. At a signal-to-noise ratio R a phase takes up 1/(√(2π) R) of its room, an
# amplitude that was known to be no larger than twice what is found √(2π)/(2 R), a frequency that
# was known to a bin about 1/R; a search over m values costs ln m. The difference of two scores is
# the natural logarithm of the odds.

TELLS = 3.0  # natural logarithm of odds of 20 to 1, from which one of two is named alone


def in_time(own: Array, amplitudes: Array, drops: Array, searched: float) -> float:
    """Score of an oscillation bound to time; in a turn that is better without it, it is not.

    own : (k,), drops of chi-squared with a frequency, an amplitude and a phase of each turn's own
    amplitudes, drops : (k,), in each turn and by it, at one frequency for all
    searched : how many frequencies and axes were tried
    """
    room = _phase(own) + _amplitude(own)
    each = np.maximum(own / 2 - room - _frequency(own), 0.0)
    there = each > 0
    if not there.any():
        return float(-np.log(searched))
    # One of the frequencies is that of the search.
    apart = float(each.sum() + _frequency(own[there]).max())
    weight = drops[there] / amplitudes[there] ** 2
    off = amplitudes[there] - np.average(amplitudes[there], weights=weight)
    same = (drops[there] - weight * off**2) / 2 - _phase(drops[there])
    together = float(same.sum() - _amplitude(drops[there].sum()))
    return max(apart, together) - float(np.log(searched))


def in_angle(drop: float, searched: float) -> float:
    """Score of an oscillation bound to the angle, by the drop of chi-squared in all turns."""
    room = _phase(np.asarray(drop)) + _amplitude(np.asarray(drop))
    return float(drop / 2 - room - np.log(searched))


def _phase(drop: Array) -> Array:
    """ln of prior over posterior room of a phase; R² is the drop."""
    return np.asarray(np.log(np.maximum(np.sqrt(2 * np.pi * drop), 1.0)))


def _amplitude(drop: Array) -> Array:
    """The same of an amplitude."""
    return np.asarray(np.log(np.maximum(2 * np.sqrt(drop / (2 * np.pi)), 1.0)))


def _frequency(drop: Array) -> Array:
    """The same of a frequency: sigma is √6/(π R T), Rife & Boorstyn (1974)."""
    return np.asarray(np.log(np.maximum(np.sqrt(drop), 1.0)))
