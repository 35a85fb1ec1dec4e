"""How much noise each pair of positions held, read from how parameters scatter epoch by epoch.

S0's six-position formula, solved for each epoch alone, has for sensor r and the pair with axis k up
and down var(M_rk) = σ_rk² / (2 g²), and for the bias the sum of all three σ_rk² / 18. So the
published variances (table 5-4) tell the noise of every sensor in every attitude: a table that sways
shows in the level axes only.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def position_noise(variances: Array, size: float) -> Array:
    """Noise per sample of each sensor (rows) in each pair of positions (columns), (3, 3).

    Parameters
    ----------
    variances : (3, 3), of the elements of M from single epochs
    size : the input, g in m/s²
    """
    return np.asarray(size * np.sqrt(2 * variances))


def bias_variance(noise: Array) -> Array:
    """Variance of the bias of each sensor by the same formula, (3,), for the check against it."""
    return np.asarray(np.sum(noise**2, axis=1) / 18)
