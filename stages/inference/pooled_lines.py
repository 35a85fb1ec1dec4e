"""A line at one frequency in several records, each with a phase of its own.

The sum of the periodograms of k records of white noise, each over its level, is distributed like
chi-squared with 2k degrees of freedom. So a line that no record shows by itself may stand out of
all together.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.signal import czt

from stages.inference.tails import log_chi_squared_beyond

Array = NDArray[np.float64]

OVERSAMPLED = 2  # the search steps by half a bin of the longest record


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
    return frequency, drop, log_chi_squared_beyond(drop, degrees)
