"""The distribution where models of a class disagree: their mixture, weighted by probability."""

import numpy as np

from inertial.arrays import Array


def disagree(values: Array, covariances: Array) -> bool:
    """Whether a member is off from the first, the likeliest, by more than the sigma of that.

    A parameter that one determines and another does not is a disagreement too.

    Parameters
    ----------
    values : (m, p), of every member; NaN: not determined
    covariances : (m, p, p)
    """
    known = np.isfinite(values)
    if (known != known[0]).any():
        return True
    sigma = np.sqrt(np.diagonal(covariances[0]))
    return bool((np.abs(values - values[0]) > sigma)[:, known[0]].any())


def mixture(values: Array, covariances: Array, weights: Array) -> tuple[Array, Array]:
    """Mean (p,) and covariance (p, p) of a mixture of distributions.

        mean = Σ wᵢ xᵢ,   covariance = Σ wᵢ (Cᵢ + (xᵢ − mean) (xᵢ − mean)ᵀ)

    the law of total covariance: that within the members, and that between them. A parameter that
    one member does not determine is NaN, and so are its row and column.

    Parameters
    ----------
    values : (m, p), of every member; NaN: not determined
    covariances : (m, p, p)
    weights : (m,), of any sum; a member of weight 0 has no part in it
    """
    part = weights > 0
    share, values, covariances = weights[part] / weights.sum(), values[part], covariances[part]
    mean = share @ values
    off = values - mean
    within = np.einsum("m,mij->ij", share, covariances)
    covariance = within + np.einsum("m,mi,mj->ij", share, off, off)
    unknown = ~np.isfinite(mean)
    covariance[unknown] = np.nan
    covariance[:, unknown] = np.nan
    return mean, covariance


def beside_effects(covariance: Array, likeliest: Array, weight: float) -> Array:
    """The covariance of a mixture, with the effects of the likeliest member behind it.

    The parameters of the effects have the covariance of that member; where another member is true
    they are independent of the others, so that their correlation counts with its weight.

    Parameters
    ----------
    covariance : (p, p), of the mixture
    likeliest : (p + k, p + k), of the likeliest member
    weight : of the likeliest member, of a sum of 1
    """
    size = len(covariance)
    whole = likeliest.copy()
    whole[:size, :size] = covariance
    whole[:size, size:] *= weight
    whole[size:, :size] *= weight
    return whole
