"""Survival functions of the usual distributions and their inverses, named as in scipy.stats.

They call scipy.special: to load scipy.stats takes longer than most stages run.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy import special
from scipy.optimize import brentq

from inertial.arrays import Array

MIN_RATIO = 1.01  # of two sums of squares: below it they count as equal
POLE_FRACTION = 1 - 1e-9  # of the distance to the pole of the cumulant generating function


def _reals(*values: ArrayLike) -> tuple[Array, ...]:
    return tuple(np.asarray(value, np.float64) for value in values)


def chi2_sf(value: ArrayLike, degrees: ArrayLike) -> Array:
    """Probability of a larger chi-squared."""
    v, n = _reals(value, degrees)
    return np.asarray(special.chdtrc(n, np.maximum(v, 0.0)))


def chi2_logsf(value: ArrayLike, degrees: ArrayLike) -> Array:
    """Natural logarithm of `chi2_sf`; −∞ where that underflows."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(chi2_sf(value, degrees)))


def chi2_isf(chance: ArrayLike, degrees: ArrayLike) -> Array:
    """Inverse of `chi2_sf`."""
    p, n = _reals(chance, degrees)
    return np.asarray(special.chdtri(n, p))


def ncx2_sf(value: ArrayLike, degrees: ArrayLike, centre: ArrayLike) -> Array:
    """Probability of a larger noncentral chi-squared."""
    return np.asarray(1.0 - special.chndtr(*_reals(value, degrees, centre)))


def ncx2_pdf(value: ArrayLike, degrees: ArrayLike, centre: ArrayLike) -> Array:
    """Density of the noncentral chi-squared of a centre above zero."""
    x, n, c = _reals(value, degrees, centre)
    order = n / 2 - 1
    bessel = special.ive(order, np.sqrt(c * x))  # scaled: times e^−√(c x)
    return np.asarray(0.5 * np.exp(-((x**0.5 - c**0.5) ** 2) / 2) * (x / c) ** (order / 2) * bessel)


def f_sf(value: ArrayLike, degrees: ArrayLike, of_noise: ArrayLike) -> Array:
    """Probability of a larger F, the ratio of two mean squares with these degrees of freedom."""
    v, n, m = _reals(value, degrees, of_noise)
    return np.asarray(special.fdtrc(n, m, np.maximum(v, 0.0)))


def f_isf(chance: ArrayLike, degrees: ArrayLike, of_noise: ArrayLike) -> Array:
    """Inverse of `f_sf`, by the lower tail of 1/F: exact for any small probability."""
    p, n, m = _reals(chance, degrees, of_noise)
    return np.asarray(1.0 / special.fdtri(m, n, p))


def t_sf(value: ArrayLike, degrees: ArrayLike) -> Array:
    """Probability of a larger value of Student's t."""
    v, n = _reals(value, degrees)
    return np.asarray(special.stdtr(n, -v))


def t_isf(chance: ArrayLike, degrees: ArrayLike) -> Array:
    """Inverse of `t_sf`."""
    p, n = _reals(chance, degrees)
    return np.asarray(-special.stdtrit(n, p))


def norm_sf(value: ArrayLike) -> Array:
    """Probability of a larger standard normal value."""
    (v,) = _reals(value)
    return np.asarray(special.ndtr(-v))


def norm_isf(chance: ArrayLike) -> Array:
    """Inverse of `norm_sf`."""
    (p,) = _reals(chance)
    return np.asarray(-special.ndtri(p))


def quadratic_ratio_sf(numerator: Array, denominator: Array, ratio: float) -> float:
    """Probability that one sum of squares of white noise exceeds another by a factor r.

        y'By / y'Ay ≥ r   ⇔   Σ λ_i z_i² ≥ 0,    λ: eigenvalues of B − r A,  z: normal, independent

    The two sums may share readings. Saddlepoint approximation (Lugannani and Rice; Kuonen 1999,
    Biometrika 86, 929) with a relative error of some per cent far into the tail.

    Parameters
    ----------
    numerator, denominator : B and A, (n, n), symmetric, of trace 1 each
    ratio : r; the result is 1 for r up to `MIN_RATIO`
    """
    if ratio <= MIN_RATIO:
        return 1.0
    weights = np.linalg.eigvalsh(numerator - ratio * denominator)
    weights = weights / np.abs(weights).max()
    if weights.max() <= 0:  # impossible for any y
        return 0.0

    def derivative(at: float) -> Array:
        return np.asarray(weights / (1 - 2 * at * weights))

    # Exponential tilting towards the numerator: the saddlepoint is positive.
    saddle = brentq(lambda s: float(derivative(s).sum()), 0.0, POLE_FRACTION / (2 * weights.max()))
    cumulant = -0.5 * float(np.sum(np.log1p(-2 * saddle * weights)))
    w = np.sqrt(-2 * cumulant)
    u = saddle * np.sqrt(2 * float(np.sum(derivative(saddle) ** 2)))
    return float(norm_sf(w + np.log(u / w) / w))
