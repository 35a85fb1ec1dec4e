"""Lines of one frequency in the spectra of a channel that last for some time."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft
from scipy.special import gammaincc, gammainccinv

from inertial.arrays import Array, Booleans
from inertial.signal.scatter import median

Complex = NDArray[np.complex128]
Singles = NDArray[np.float32]

WINDOW = 256  # readings of a spectrum
HOP = 128  # readings from one to the next
PART_BINS = (
    8  # bins; so many periods in a window at least: slower ones cannot be distinguished from motion
)
MAX_RATIO = 12.0  # times the background: limit of the contribution of a single window
STRETCH_WINDOWS = (4, 8, 16, 32, 64, 128)  # windows that are taken together
FALSE_ALARM_LEVEL = 1e-4  # chance of a line in a campaign
# Sums that are tested in a campaign like S0's
SEARCHED_SUMS = 1.2e6 / HOP * (WINDOW / 2) * len(STRETCH_WINDOWS)
NOISE_RATIO = 2.0  # times the background: the largest of three bins, by noise alone
# The last part has nothing above it: one median is less than the larger of two
ONE_SIDED_FACTOR = 0.76
LINE_BINS = 8  # bins on each side that a line takes with it
# Of full: how well a line must keep its phase from one window to the next but one
MIN_COHERENCE = 0.5
MIN_PERIODS = 6  # in a log that is no longer than one window
MIN_SLOW_RATIO = 6.0  # times the power of anything slower in it
BIN_STEPS = 4  # steps in a bin, by which its line is sought
MIN_DISTANCE_BINS = 2.5  # bins from a line to what is beside it
MIN_OTHER_BINS = 6  # bins beside it
MAX_HALF_DIFFERENCE = 0.3  # of the whole: difference of its two halves
CAMPAIGN_CHANNELS = 6 * 12  # of a campaign in so short logs
MAX_LINES = 32  # stretches in one channel of a piece that are examined

# Of the sum over windows in white noise: its shape for each window, and its scale. The background
# scatters too, and for windows that overlap alike: 0.7 and 1.2 fit 12 million readings for 16
# windows and more, for 4 and 8 the tail is longer.
SHAPE, SCALE = 0.7, 1.35

_MIN_SUM = {
    length: SCALE * float(gammainccinv(SHAPE * length, FALSE_ALARM_LEVEL / SEARCHED_SUMS))
    for length in STRETCH_WINDOWS
}


@dataclass(frozen=True)
class Line:
    """A line in the windows [first, after) of a channel.

    frequency: cycles per interval; p_value: chance of it, the search of a campaign paid for.
    """

    first: int
    after: int
    frequency: float
    p_value: float


def windows(values: Array, length: int = WINDOW) -> Array:
    """The windows of (n,) readings, each less its straight line and Hann-weighted, (k, length)."""
    cut = in_windows(values, length)
    time = np.arange(length) - (length - 1) / 2
    slope = cut @ time / (time @ time)
    level = cut - cut.mean(axis=1)[:, None] - slope[:, None] * time
    return np.asarray(level * hann(length))


def in_windows(values: Array, length: int = WINDOW) -> Array:
    """What is there for (n,) readings, by windows, (k, length)."""
    return np.lib.stride_tricks.sliding_window_view(values, length)[::HOP]


def hann(length: int) -> Array:
    """The weights of a window, (length,)."""
    return np.hanning(length + 1)[:-1]


def lines(cut: Array, time: Array) -> Iterator[Line]:
    """The lines in a channel's windows, the clearest first.

    Each window is compared with its own spectrum beside the bin. Of white noise that ratio is
    about exponentially distributed, and its sum over windows, though they overlap by half, gamma.

    Parameters
    ----------
    cut : (k, WINDOW), readings
    time : (k, WINDOW), their times in intervals
    """
    power = np.abs(rfft(cut.astype(np.float32), axis=1)[:, :-1]) ** 2
    ratio = _ratio(power)
    for _ in range(MAX_LINES):
        seed = _clearest(ratio)
        if seed is None:
            return
        first, after, bin_, chance = seed
        beside = ratio[:, bin_ - 1 : bin_ + 2].max(axis=1)
        first, after = _stretch(beside, first, after)
        near = slice(max(bin_ - LINE_BINS, PART_BINS), bin_ + LINE_BINS + 1)
        if after - first >= STRETCH_WINDOWS[0]:
            # A strong line is capped in several bins; the largest of them is nearest to it, by the
            # median, for in a single window a motion may be larger.
            # Most windows may lie between the turns that have it.
            inside = slice(first, after)
            having = _having(beside[inside])
            typical = np.median(power[inside, near][having], axis=0)
            peak = near.start + int(np.argmax(typical))
            frequency, in_step = _tuned(cut[inside], time[inside], peak / WINDOW, having)
            if in_step > MIN_COHERENCE:
                yield Line(first, after, frequency, min(chance * SEARCHED_SUMS, 1.0))
        ratio[max(first - 2, 0) : after + 2, near] = 0.0


def line_of_one(cut: Array, time: Array) -> Iterator[Line]:
    """The line of a single window (1, length), if there is one.

    It must exceed the median of all other bins significantly, be larger than anything slower, which
    coloured noise and motion are not, and be the same in both halves.
    """
    length = cut.shape[1]
    power = np.abs(np.fft.rfft(cut[0], BIN_STEPS * length)) ** 2
    bins = np.arange(len(power)) / BIN_STEPS
    peak = int(np.argmax(np.where(bins < MIN_PERIODS, 0.0, power)))
    apart = np.abs(bins - bins[peak]) > MIN_DISTANCE_BINS
    others = power[apart & (bins >= MIN_PERIODS)][::BIN_STEPS]
    slower = power[apart & (bins < bins[peak])]
    if len(others) < MIN_OTHER_BINS or power[peak] < MIN_SLOW_RATIO * slower.max(initial=0.0):
        return
    ratio = float(np.log(2) * power[peak] / np.median(others))
    # Of a background from m bins, of which a Hann window makes two thirds independent.
    m = len(others) / 1.5
    p_value = min(float((1 + ratio / m) ** -m) * CAMPAIGN_CHANNELS * length / 2, 1.0)
    frequency = float(bins[peak] / length)
    half = length // 2
    raw = cut / np.maximum(hann(length), 1e-3)
    parts = [
        phasors(raw[:, part] * hann(half), time[:, part], frequency)[0]
        for part in (slice(0, half), slice(length - half, length))
    ]
    agreed = abs(parts[0] - parts[1]) < MAX_HALF_DIFFERENCE * (abs(parts[0]) + abs(parts[1]))
    if agreed and p_value < FALSE_ALARM_LEVEL:
        yield Line(0, 1, frequency, p_value)


def phasors(cut: Array, time: Array, frequency: float) -> Complex:
    """Amplitude and phase of a line in each window, (k,); cut and time (k, length)."""
    turning = np.exp(-2j * np.pi * frequency * time)
    return np.asarray(np.einsum("ij,ij->i", cut, turning) * 2 / hann(cut.shape[1]).sum())


def _ratio(power: Singles) -> Singles:
    """The spectra (k, WINDOW / 2) over the background beside each bin, the same shape.

    Beside it: the larger of the medians of 16 bins below and of 16 above, without the 8 to which
    it belongs. The flank of a motion lies above the bins on its right, not above those on its left.
    """
    parts = power.reshape(len(power), -1, PART_BINS)
    pairs = np.concatenate([parts[:, :-1], parts[:, 1:]], axis=2)
    of_pairs = median(pairs)
    ends = median(parts[:, 0, 1:]), median(parts[:, -1])
    lowest, highest = (end[:, None] for end in ends)
    none = np.zeros_like(lowest)
    below = np.hstack([none, lowest, of_pairs[:, :-1]])
    above = np.hstack([of_pairs[:, 1:], highest, none])
    beside = np.repeat(np.maximum(below, above), PART_BINS, axis=1)
    ratio = np.divide(np.log(2) * power, beside, out=np.zeros_like(power), where=beside > 0)
    ratio[:, :PART_BINS] = 0.0
    ratio[:, -PART_BINS:] *= ONE_SIDED_FACTOR
    return np.asarray(np.minimum(ratio, MAX_RATIO))


def _clearest(ratio: Singles) -> tuple[int, int, int, float] | None:
    """The windows [first, after) and the bin whose sum chance explains least, and that chance."""
    sums = np.cumsum(ratio, axis=0, dtype=np.float64)
    sums = np.vstack([np.zeros((1, sums.shape[1])), sums])
    best = None
    for length in STRETCH_WINDOWS:
        if length > len(ratio):
            break
        together = sums[length:] - sums[:-length]
        first, bin_ = divmod(int(np.argmax(together)), ratio.shape[1])
        largest = float(together[first, bin_])
        if largest > _MIN_SUM[length]:
            chance = float(gammaincc(SHAPE * length, largest / SCALE))
            if best is None or chance < best[3]:
                best = first, first + length, bin_, chance
    return best


def _stretch(ratio: Singles, first: int, after: int) -> tuple[int, int]:
    """The windows that hold a line, by (k,) ratios, from those in which it was detected.

    Halfway between the line and noise is the level; the sum above it is the largest.
    """
    inside = ratio[first:after]
    # Windows taken together may hold a break; the median is then that of the line.
    above = ratio - (max(inside.mean(), np.median(inside)) + NOISE_RATIO) / 2
    sums = np.append(0.0, np.cumsum(above))
    middle = first + int(np.argmax(above[first:after]))
    start = int(np.argmin(sums[: middle + 1]))
    return start, middle + 1 + int(np.argmax(sums[middle + 1 :]))


def _having(ratio: Singles) -> Booleans:
    """Which windows of a stretch have its line, (k,): half of its mean above noise, or more."""
    return np.asarray(ratio >= min((float(ratio.mean()) + NOISE_RATIO) / 2, float(ratio.max())))


def _tuned(cut: Array, time: Array, frequency: float, having: Booleans) -> tuple[float, float]:
    """The frequency by which a line keeps its phase, and how well it does.

    From window to window at first, then over ever more of them. `having`: which have it, (k,).
    """
    lag, in_step = 1, 0.0
    while lag < max(len(cut) / 2, 3) and lag < len(cut):
        tones = phasors(cut, time, frequency)
        sizes = np.abs(tones)
        # No window weighs more than twice its share.
        tones /= np.maximum(sizes, 2 * np.median(sizes[having]))
        product = tones[lag:] * tones[:-lag].conj()
        coherence = float(np.abs(product.sum()) / max(np.abs(product).sum(), 1e-300))
        if lag == 2:
            in_step = coherence
        if coherence < MIN_COHERENCE:
            break
        frequency += float(np.angle(product.sum())) / (2 * np.pi * lag * HOP)
        lag *= 2
    return frequency, in_step


MAX_FITTED_READINGS = 512  # readings at the most, inside, from which amplitude and phase are had
MAX_MEAN_READINGS = 101  # readings of the moving mean that is taken off


def edges(
    values: Array, time: Array, inside: tuple[int, int], outside: tuple[int, int], frequency: float
) -> tuple[int, int]:
    """The first reading of an oscillation, and the one after its last.

    From readings well inside it the oscillation s is continued to the outside. Each reading y
    contributes (y − s/2) s, the logarithm of the likelihood ratio in white noise; the edge is where
    the sum of this over all readings within is largest.

    Parameters
    ----------
    values : (n,), readings
    time : (n,), intervals
    inside : places between which it certainly is
    outside : places beyond which it is not sought
    frequency : cycles per interval
    """
    level = _levelled(values, frequency)
    first, after = inside
    length = min(after - first, MAX_FITTED_READINGS)
    start = _edge(level, time, slice(first, first + length), outside[0], frequency)
    end = _edge(
        level[::-1],
        time[::-1],
        slice(len(level) - after, len(level) - after + length),
        len(level) - outside[1],
        frequency,
    )
    return start, len(level) - end


def _edge(level: Array, time: Array, inside: slice, outside: int, frequency: float) -> int:
    """The first place of an oscillation that is there `inside`, and not before `outside`."""
    # Times are large where a log is long; the phase is counted from the reading that is nearest.
    phase = 2 * np.pi * frequency * (time - time[inside.start])
    columns = np.column_stack([np.cos(phase), np.sin(phase)])
    parts = np.linalg.lstsq(columns[inside], level[inside], rcond=None)[0]
    tone = columns[outside : inside.start] @ parts
    # The corner of a ramp leaves more than any oscillation; no reading weighs more than twice its.
    most = 2 * float(np.linalg.norm(parts))
    contribution = (np.clip(level[outside : inside.start], -most, most) - tone / 2) * tone
    # Summed from the inside out; nothing more than what is inside is one of the choices.
    together = np.append(0.0, np.cumsum(contribution[::-1]))
    return int(inside.start) - int(np.argmax(together))


def _levelled(values: Array, frequency: float) -> Array:
    """Readings less their moving mean over as near to whole periods as an odd number may be."""
    lengths = np.arange(3, min(int(4 / frequency) + 3, MAX_MEAN_READINGS, len(values)) + 1, 2)
    passed = np.abs(np.sin(np.pi * frequency * lengths) / (lengths * np.sin(np.pi * frequency)))
    length = int(lengths[np.argmin(passed)])
    padded = np.pad(values - values.mean(), length // 2, mode="reflect", reflect_type="odd")
    sums = np.append(0.0, np.cumsum(padded))
    return np.asarray(values - values.mean() - (sums[length:] - sums[:-length]) / length)
