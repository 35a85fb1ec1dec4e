"""Tail probabilities of the usual distributions, and their bounds."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special
from scipy.optimize import brentq

# ---- Chances of what noise does: tails of the usual distributions, and their bounds.
#
# They are scipy's special functions; scipy.stats has the same by name, but to load it takes longer
# than most stages work.

Array = NDArray[np.float64]


def _reals(*values: ArrayLike) -> tuple[Array, ...]:
    return tuple(np.asarray(value, np.float64) for value in values)


def chi_squared_beyond(value: ArrayLike, degrees: ArrayLike) -> Array:
    """The chance of a larger chi-squared."""
    v, n = _reals(value, degrees)
    return np.asarray(special.chdtrc(n, np.maximum(v, 0.0)))


def log_chi_squared_beyond(value: ArrayLike, degrees: ArrayLike) -> Array:
    """Its natural logarithm; −∞ where the chance is below what a number can tell."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(chi_squared_beyond(value, degrees)))


def chi_squared_bound(chance: ArrayLike, degrees: ArrayLike) -> Array:
    """The chi-squared that is exceeded with this chance."""
    p, n = _reals(chance, degrees)
    return np.asarray(special.chdtri(n, p))


def noncentral_beyond(value: ArrayLike, degrees: ArrayLike, centre: ArrayLike) -> Array:
    """The chance of a larger noncentral chi-squared."""
    return np.asarray(1.0 - special.chndtr(*_reals(value, degrees, centre)))


def ratio_beyond(value: ArrayLike, degrees: ArrayLike, of_noise: ArrayLike) -> Array:
    """The chance of a larger F, a ratio of two mean squares on their degrees of freedom."""
    v, n, m = _reals(value, degrees, of_noise)
    return np.asarray(special.fdtrc(n, m, np.maximum(v, 0.0)))


def ratio_bound(chance: ArrayLike, degrees: ArrayLike, of_noise: ArrayLike) -> Array:
    """The F that is exceeded with this chance: of 1/F the other tail, exact however small it is."""
    p, n, m = _reals(chance, degrees, of_noise)
    return np.asarray(1.0 / special.fdtri(m, n, p))


def student_beyond(value: ArrayLike, degrees: ArrayLike) -> Array:
    """The chance of a larger value of Student's t."""
    v, n = _reals(value, degrees)
    return np.asarray(special.stdtr(n, -v))


def normal_beyond(value: ArrayLike) -> Array:
    """The chance of a larger standard normal value."""
    (v,) = _reals(value)
    return np.asarray(special.ndtr(-v))


# ---- The chance that noise makes one sum of squares of readings exceed another by some factor.
#
#     y'By / y'Ay ≥ r   ⇔   Σ λ_i z_i² ≥ 0,    λ: eigenvalues of B − r A,  z: normal, independent
#
# The two sums may share readings. The chance is that of the saddlepoint (Lugannani and Rice;
# Kuonen 1999, Biometrika 86, 929), which keeps its relative error, some per cent, far out.

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
