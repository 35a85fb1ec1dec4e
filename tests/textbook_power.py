"""The power that no search of a catalogue can exceed, by the noncentral chi-squared law."""

import numpy as np
from scipy import stats


def power_limit(snr, degrees: int, effects: int, level: float, values: float = 1.0) -> np.ndarray:
    """Probability that an effect of this size is detected at the family-wise level.

    The drop of chi-squared is noncentral chi-squared; it must exceed what noise does with
    the share of the level of one effect among `effects` and of one value among the `values` of
    its own scan (the number of independent ones; their count is a lower bound of the power).
    """
    bound = stats.chi2.isf(level / effects / values, degrees)
    snr = np.asarray(snr)
    alone = stats.chi2.sf(bound, degrees)
    return np.where(snr == 0, alone, stats.ncx2.sf(bound, degrees, snr**2))
