"""Sizes of effects that were named because they are large.

An effect is named where its drop of chi-squared exceeds a threshold. In units in which its k
parameters are estimated with unit variance, z ~ N(μ, 1) with |μ| the signal-to-noise ratio, that
is |z|² > c, and given that, z is on average too large,

    E(z) = μ (1 + h),    h = 2 f₍k+2₎(c) / Q₍k₎(c),

f and Q density and survival function of the noncentral chi-squared of centre |μ|². That bias is
subtracted where it is estimated, at |μ̂|² = |z|² − k: the parametric bootstrap (Efron & Tibshirani
1993, chapter 10; of selected effects Sun & Bull 2005) in closed form. But |μ̂| is too large as well,
so what is subtracted is too little of an effect at the threshold. What is left of the bias is
estimated in the same way and subtracted too: the bootstrap iterated once (Hall 1992, chapter 1). Of
z g(|z|²) it is an integral, for E(z g) = μ ∫ g f₍k+2₎ / Q₍k₎ beyond c. By symmetry only the
length of the estimate changes. The maximum of the likelihood given the selection, and its mean,
subtract too much of an effect that is far enough above the threshold to be named anyway (Zhong &
Prentice 2008).

Along the estimate its variance is that of |z| given the selection, propagated through the
correction. Across it the angle between z and μ counts, which at given |z| follows the distribution
of von Mises and Fisher with concentration |z| |μ|: a variance of |μ|/|z|. Well above the threshold
h vanishes, and all of it is least squares.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import special

from inertial.arrays import Array
from inertial.estimation.probability import ncx2_pdf, ncx2_sf

BEYOND = 8.0  # of |z| above the threshold, where nothing is subtracted any more
NODES, WEIGHTS = (np.array(each) for each in special.roots_sh_legendre(40))  # of 0 to 1
MIN_CENTRE = 1e-6
STEP = 1e-3  # of |z|, for a slope
TINY = 1e-300  # of |z|², of an effect that is exactly zero


@dataclass(frozen=True)
class Selected:
    """What having been selected changes in a least-squares estimate.

    `factor`: of the values; `along`, `across`: variance in the direction of the estimate, and
    perpendicular to it, in units of that by least squares.
    """

    factor: float
    along: float
    across: float


NOT_SELECTED = Selected(1.0, 1.0, 1.0)


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
    threshold = min(threshold, statistic)
    length = float(np.sqrt(statistic))
    near = length + STEP * np.array([-1, 0, 1])
    below, factor, above = _iterated(near**2, degrees, threshold)
    slope = float(near[2] * above - near[0] * below) / (2 * STEP)
    # Of the logarithm of Q: first derivative over |μ|, and second derivative.
    centre = np.array(statistic - degrees)
    first, second = (_excess(centre, degrees + more, degrees, threshold) for more in (2, 4))
    curvature = first + centre * (second - first - first**2)
    return Selected(float(factor), slope**2 * float(1 + curvature), float(factor))


def _excess(centre: Array, degrees: int, selected_by: int, threshold: float) -> Array:
    """2 f(c) / Q(c), f of `degrees`, Q of `selected_by`; of a centre above 0."""
    beyond = ncx2_sf(threshold, selected_by, centre)
    return np.asarray(2 * ncx2_pdf(threshold, degrees, centre) / beyond)


def _once(statistic: Array, degrees: int, threshold: float) -> Array:
    """1 − g, g the factor by the bias where it is estimated, without what is left of it."""
    centre = np.maximum(statistic - degrees, MIN_CENTRE)
    return np.sqrt(centre / statistic) * _excess(centre, degrees + 2, degrees, threshold)


def _iterated(statistic: Array, degrees: int, threshold: float) -> Array:
    """The factor of estimates of some |z|², (n,)."""
    centre = np.maximum(statistic - degrees, MIN_CENTRE)
    length = np.sqrt(threshold) + BEYOND * NODES
    others = length**2  # |z|² of other draws
    density = ncx2_pdf(others, degrees + 2, centre[:, None]) * 2 * length * BEYOND * WEIGHTS
    subtracted = density @ _once(others, degrees, threshold)
    left = _excess(centre, degrees + 2, degrees, threshold)
    left -= subtracted / ncx2_sf(threshold, degrees, centre)
    return 1 - _once(statistic, degrees, threshold) - np.sqrt(centre / statistic) * left


def corrected(
    values: Array, covariance: Array, effects: Mapping[tuple[int, ...], Selected]
) -> tuple[Array, Array]:
    """Estimates after selection, and their covariance; what is correlated moves along.

    One effect after the other, each beside what the others have moved by then: of effects that are
    hard to distinguish the first takes the correction, and no variance falls below zero.

    Parameters
    ----------
    values, covariance : by least squares, (n,) and (n, n); NaN where not observable
    effects : of each the places of its parameters among the values
    """
    known = np.isfinite(values)
    values, covariance = values.copy(), covariance.copy()
    for places, how in effects.items():
        own = [place for place in places if known[place]]
        if not own or how == NOT_SELECTED:
            continue
        block, size = covariance[np.ix_(own, own)], values[own]
        follows = regressed(covariance[:, own], block)
        along = size / np.sqrt(max(size @ regressed(size[None], block)[0], TINY))
        added = (how.across - 1) * block + (how.along - how.across) * np.outer(along, along)
        values += (how.factor - 1) * follows @ size
        covariance += follows @ added @ follows.T
    return values, covariance


def regressed(crossed: Array, block: Array) -> Array:
    """By how much estimates change per change of others: (n, m) of covariances (n, m), (m, m)."""
    size = np.sqrt(np.diag(block))
    inverse = np.linalg.pinv(block / np.outer(size, size), hermitian=True)
    return np.asarray(crossed @ (inverse / np.outer(size, size)))
