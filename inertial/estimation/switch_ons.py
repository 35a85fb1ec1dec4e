"""By what the bias of a sensor differs from one switch-on to the next, within one campaign.

The bias of each part of the campaign that lies between two switch-ons is one of q independent
deviations d ~ N(0, τ²) from a common one. All other unknowns eliminated, the equations say N d = r.
With the eigenvalues λ and vectors V of N and s = Vᵀ r, −2 log of the restricted likelihood is

    Σ log(1 + τ² λ) − Σ τ² s² / (1 + τ² λ),

and the expected information of τ² is ½ Σ λ²/(1 + τ² λ)² (Patterson & Thompson 1971; Searle, Casella
& McCulloch 1992). One eigenvalue is 0, for a common deviation is the bias: so q − 1 are free.

τ of few switch-ons is not well known, so a bias is off by Student's distribution of q − 1 degrees.
The covariance gets the normal one with the same interval of 95 % (GUM G.3).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import ndtri, stdtrit

from inertial.arrays import Array

TWO_SIDED = 0.975  # quantile at the end of an interval of 95 %
ONE_SIDED = 2.706  # rise of the deviance at the one-sided limit of 95 %
NO_INFORMATION = 1e-9  # relative to the largest eigenvalue
# Of the variance that is sought, relative to the smallest and the largest of the deviations: some
# combinations are known a million times better than others, where few positions lie between two.
RANGE = (1e-8, 1e4)


@dataclass(frozen=True, eq=False)
class SwitchOns:
    """Of each axis, (3,), unit of the readings; NaN where it is not recorded.

    `count`: of switch-ons; `value`: standard deviation between them; `sigma`: of that, NaN where 0
    is the likeliest; `upper`: one-sided 95 %.
    """

    count: int
    value: Array
    sigma: Array
    upper: Array

    @property
    def covering(self) -> Array:
        """The standard deviation in the covariance, (3,); 0 where none is known."""
        return covering(self.value, self.count)


def covering(value: Array, count: int) -> Array:
    """The normal standard deviation whose interval of 95 % is that of Student's distribution."""
    return np.nan_to_num(value) * float(stdtrit(count - 1, TWO_SIDED) / ndtri(TWO_SIDED))


def between(information: Array, right: Array) -> tuple[float, float, float]:
    """The standard deviation of q biases, its sigma and upper limit; N, (q, q), and r, (q,)."""
    values, vectors = np.linalg.eigh(information)
    there = values > NO_INFORMATION * max(float(values[-1]), 0.0)
    if not there.any():
        return np.nan, np.nan, np.nan
    values, squares = values[there], (vectors.T @ right)[there] ** 2

    def deviance(variance: float) -> float:
        grown = 1 + variance * values
        return float(np.sum(np.log(grown)) - np.sum(variance * squares / grown))

    sizes = squares / values**2 + 1 / values
    low, high = np.log(RANGE[0] * sizes.min()), np.log(RANGE[1] * sizes.max())
    found = minimize_scalar(lambda x: deviance(np.exp(x)), bounds=(low, high), method="bounded")
    best = float(np.exp(found.x)) if found.fun < 0 and found.x > low + 1 else 0.0

    def rise(x: float) -> float:
        return deviance(np.exp(x)) - deviance(best) - ONE_SIDED

    start = np.log(best) if best else low
    upper = float(np.exp(brentq(rise, start, high) / 2)) if rise(high) > 0 else np.inf
    information_of_variance = 0.5 * float(np.sum((values / (1 + best * values)) ** 2))
    sigma = 1 / np.sqrt(information_of_variance) / (2 * np.sqrt(best)) if best else np.nan
    return float(np.sqrt(best)), float(sigma), upper
