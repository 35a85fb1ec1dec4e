"""Sizes of effects that were named because they are large.

An effect is named where its drop of chi-squared exceeds a threshold. In units in which its k
parameters are estimated with unit variance, z ~ N(μ, 1) with |μ| the signal-to-noise ratio, that
is |z|² > c, and given that, z is on average too large,

    E(z) = μ (1 + h),    h = 2 f₍k+2₎(c) / Q₍k₎(c),

f and Q density and survival function of the noncentral chi-squared of centre |μ|². That bias is
subtracted where it is estimated, at |μ̂|² = |z|² − k: the parametric bootstrap (Efron & Tibshirani
1993, chapter 10; of selected effects Sun & Bull 2005) in closed form. By symmetry the estimate
only becomes shorter. The maximum of the likelihood given the selection, and its mean, subtract too
much of an effect that is far enough above the threshold to be named anyway (Zhong & Prentice 2008).

Along the estimate its variance is that of |z| given the selection, propagated through the
correction. Across it the angle between z and μ counts, which at given |z| follows the distribution
of von Mises and Fisher with concentration |z| |μ|: a variance of |μ|/|z|. Well above the threshold
h vanishes, and all of it is least squares.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import ncx2_pdf, ncx2_sf

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Selected:
    """What having been selected changes in a least-squares estimate.

    `factor`: of the values; `along`, `across`: variance in the direction of the estimate, and
    perpendicular to it, in units of that by least squares; `statistic`: drop of chi-squared.
    """

    factor: float
    along: float
    across: float
    statistic: float


NOT_SELECTED = Selected(1.0, 1.0, 1.0, np.inf)


def selected(statistic: float, degrees: int, threshold: float) -> Selected:
    """An effect of which the drop of chi-squared exceeded a threshold.

    Parameters
    ----------
    statistic : the drop, beside the other causes
    degrees : k, of freedom of the drop
    threshold : c
    """
    if not degrees or threshold <= degrees or statistic <= degrees:
        return NOT_SELECTED
    centre = statistic - degrees
    beyond = float(ncx2_sf(min(threshold, statistic), degrees, centre))
    first, second = (
        2 * float(ncx2_pdf(min(threshold, statistic), degrees + more, centre)) / beyond
        for more in (2, 4)
    )
    # Of the logarithm of Q: first derivative over |μ|, and second derivative.
    excess, curvature = first, first + centre * (second - first - first**2)
    ratio = float(np.sqrt(statistic / centre))
    factor, slope = 1 - excess / ratio, 1 - curvature * ratio
    return Selected(factor, slope**2 * (1 + curvature), factor, statistic)


def corrected(
    values: Array, covariance: Array, effects: Mapping[tuple[int, ...], Selected]
) -> tuple[Array, Array]:
    """Estimates after selection, and their covariance; what is correlated moves along.

    Each effect is taken as selected independently of the others.

    Parameters
    ----------
    values, covariance : by least squares, (n,) and (n, n); NaN where not observable
    effects : of each the places of its parameters among the values
    """
    known = np.isfinite(values)
    shift, change = np.zeros_like(values), np.zeros_like(covariance)
    for places, how in effects.items():
        own = [place for place in places if known[place]]
        if not own or how == NOT_SELECTED:
            continue
        block, along = covariance[np.ix_(own, own)], values[own] / np.sqrt(how.statistic)
        follows = regressed(covariance[:, own], block)
        shift += (how.factor - 1) * follows @ values[own]
        added = (how.across - 1) * block + (how.along - how.across) * np.outer(along, along)
        change += follows @ added @ follows.T
    return values + shift, covariance + change


def regressed(crossed: Array, block: Array) -> Array:
    """By how much estimates change per change of others: (n, m) of covariances (n, m), (m, m)."""
    size = np.sqrt(np.diag(block))
    inverse = np.linalg.pinv(block / np.outer(size, size), hermitian=True)
    return np.asarray(crossed @ (inverse / np.outer(size, size)))
