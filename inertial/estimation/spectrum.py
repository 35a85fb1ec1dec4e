"""White noise of a record from its spectrum, and how far a rate strays beyond it."""

import numpy as np
from numpy.typing import NDArray

# ---- How much white noise a record holds, read from its spectrum.
#
# The level is the median of the periodogram over a band, so that an oscillation,
# which fills few of its bins, and a drift, which lies below the band, do not count
# as noise.

Array = NDArray[np.float64]

FEWEST_BINS = 12  # of a band; a shorter record is read up to half its sample rate
CORRELATED = 1.5  # bins that a Hann window makes out of one that is independent


def band_levels(values: Array, rate: float, band: tuple[float, float]) -> Array:
    """The periodogram of each channel within a band, as power density of both sides.

    Parameters
    ----------
    values : (n, c), samples without gaps, in any unit U
    rate : Hz, samples per second
    band : Hz, from and to

    Returns
    -------
    (bins, c), U²/Hz; white noise of random walk N (U/√Hz) has the level N²
    """
    from scipy.signal import periodogram  # here, for it loads half of scipy

    # The stubs know arrays of one dimension only.
    frequency, density = periodogram(values, rate, "hann", detrend="linear", axis=0)  # type: ignore[call-overload]
    half = density[1:-1] / 2
    inside = (frequency[1:-1] >= band[0]) & (frequency[1:-1] <= band[1])
    return np.asarray(half[inside] if inside.sum() >= FEWEST_BINS else half[1:])


def white_level(levels: Array) -> tuple[Array, Array]:
    """The white noise of each channel and its standard deviation.

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
    relative = 0.5 / np.log(2) / np.sqrt(max(bins / CORRELATED, 1.0))
    return white, relative * white


# ---- How far the rate of a table strays while it is said to be steady.

Booleans = NDArray[np.bool_]

RUNS = 8  # of the recorded steady part: the longest stretch whose scatter is still known, to 27 %


def strays(
    rate: Array, seconds: Array, elapsed: Array, before: Booleans, missing: float, density: float
) -> float:
    """By how much the mean rate over what is missing may be off that of what is recorded, rad/s.

    The larger of two, each without what white noise adds to it. Half of the difference between
    the rates before and after: wherever between them the rate has changed, the mean lies not
    farther off. The scatter of means over runs as long as what is missing: it may stray as any
    of them. Where it is longer than an eighth of the recorded part, over runs of an eighth; that
    a longer stretch averages more is not counted on.

    Parameters
    ----------
    rate, seconds, elapsed : (k,), rad/s and s, of the steady blocks; elapsed at their middles
    before : (k,), which of them lie before the longest missing stretch
    missing : s, how long that is
    density : rad/√s, white noise along the axis
    """
    whole = float(seconds.sum())
    apart = 0.0
    if before.any() and not before.all():
        lasted = np.array([seconds[part].sum() for part in (before, ~before)])
        means = np.array([rate[part] @ seconds[part] for part in (before, ~before)]) / lasted
        excess = (means[1] - means[0]) ** 2 - density**2 * np.sum(1 / lasted)
        apart = float(np.sqrt(max(excess, 0.0))) / 2

    length = max(min(missing, whole / RUNS), float(np.median(seconds)))
    run = ((elapsed - elapsed[0]) / length).astype(np.int64)
    lasted = np.bincount(run, seconds)
    full = lasted > length / 2  # what a gap leaves of a run is not as long as the others
    scattered = 0.0
    if full.sum() > 1:
        means = np.bincount(run, rate * seconds)[full] / lasted[full]
        beyond = float(np.var(means, ddof=1) - density**2 * np.mean(1 / lasted[full]))
        scattered = float(np.sqrt(max(beyond, 0.0)))
    return max(apart, scattered)
