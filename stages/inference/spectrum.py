"""How much white noise a record holds, read from its spectrum.

The level is the median of the periodogram over a band, so that an oscillation,
which fills few of its bins, and a drift, which lies below the band, do not count
as noise.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import periodogram

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
