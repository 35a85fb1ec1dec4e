"""The power that no search of a catalogue can exceed."""

import numpy as np
from numpy.typing import NDArray

from stages.inference.tails import chi_squared_bound, noncentral_beyond

Array = NDArray[np.float64]


def power_limit(
    snr: Array | float, degrees: int, effects: int, level: float, values: float = 1.0
) -> Array:
    """Chance that an effect of this size stands out at the family-wise level.

    The drop of chi-squared is noncentral chi-squared; it must exceed what noise does with
    the share of the level of one effect among `effects` and of one value among the `values` of
    its own scan (the number of independent ones; their count is a lower bound of the power).
    """
    bound = chi_squared_bound(level / effects / values, degrees)
    return np.asarray(noncentral_beyond(bound, degrees, np.asarray(snr) ** 2))


def power(snr: Array | float, degrees: int, price: float) -> Array:
    """The same where the drop from which on the effect is named is known, see `Chance.price`."""
    return np.asarray(noncentral_beyond(price, degrees, np.asarray(snr) ** 2))
