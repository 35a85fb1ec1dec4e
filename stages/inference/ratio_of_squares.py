"""The chance that noise makes one sum of squares of readings exceed another by some factor.

    y'By / y'Ay ≥ r   ⇔   Σ λ_i z_i² ≥ 0,    λ: eigenvalues of B − r A,  z: normal, independent

The two sums may share readings. The chance is that of the saddlepoint (Lugannani and Rice; Kuonen
1999, Biometrika 86, 929), which keeps its relative error, some per cent, far out.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from stages.inference.tails import normal_beyond

Array = NDArray[np.float64]

ALIKE = 1.01  # ratio up to which nothing is asked
INSIDE = 1 - 1e-9  # of the way to where the cumulant function has its pole


def chance_of_ratio(above: Array, below: Array, ratio: float) -> float:
    """Of white noise y; `above`, `below`: (n, n), symmetric, of trace 1 each. 1 where alike."""
    if ratio <= ALIKE:
        return 1.0
    weights = np.linalg.eigvalsh(above - ratio * below)
    weights = weights / np.abs(weights).max()
    if weights.max() <= 0:  # no reading does that
        return 0.0

    def share(at: float) -> Array:
        return np.asarray(weights / (1 - 2 * at * weights))

    # The noise has to be tilted towards `above`, so the saddlepoint is on that side.
    at = brentq(lambda s: float(share(s).sum()), 0.0, INSIDE / (2 * weights.max()))
    cumulant = -0.5 * float(np.sum(np.log1p(-2 * at * weights)))
    root = np.sqrt(-2 * cumulant)
    steep = at * np.sqrt(2 * float(np.sum(share(at) ** 2)))
    return float(normal_beyond(root + np.log(steep / root) / root))
