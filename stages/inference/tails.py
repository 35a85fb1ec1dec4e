"""Chances of what noise does: tails of the usual distributions, and their bounds.

They are scipy's special functions; scipy.stats has the same by name, but to load it takes longer
than most stages work.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

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
