"""Whether values agree within their sigmas: p-values, multiple comparisons, outliers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.probability import chi2_sf, t_sf
from inertial.estimation.regression import basis

MIN_ONE_MINUS_LEVERAGE = 1e-9  # below it a reading has a column of its own and fits itself


def weighted_mean(values: Array, sigmas: Array) -> tuple[float, float, float]:
    """Mean of values by their sigmas, its sigma, and the chi-squared of the values about it."""
    weights = sigmas**-2
    mean = float(np.average(values, weights=weights))
    return mean, float(weights.sum() ** -0.5), float(weights @ (values - mean) ** 2)


def normal_p_value(in_sigmas: float, degrees: float = np.inf) -> float:
    """Two-sided p-value of an error in units of its sigma.

    `degrees`: of freedom, where sigma is estimated (Student's t).
    """
    return float(2 * t_sf(abs(in_sigmas), degrees))


def holm_rejections(p_values: Sequence[float], level: float) -> Booleans:
    """Which of n comparisons differ, (n,), at a family-wise error rate of `level` (Holm 1979).

    The smallest p-value is compared with level/n, the next with level/(n − 1), until the first
    that is larger.
    """
    p = np.asarray(p_values, dtype=np.float64)
    order = np.argsort(p)
    small = p[order] < level / np.arange(len(p), 0, -1)
    result = np.zeros(len(p), dtype=np.bool_)
    result[order] = np.logical_and.accumulate(small)
    return result


@dataclass(frozen=True)
class CommonCause:
    """One amount for k differences, its sigma, and chi-squared without and with it.

    difference of axis i = amount · shape of axis i + noise
    """

    amount: float
    sigma: float
    without: float  # of k degrees of freedom
    remaining: float  # of k − 1
    k: int

    @property
    def p_without(self) -> float:
        """p-value of the differences if there is no cause."""
        return float(chi2_sf(self.without, self.k))


def common_cause(differences: Array, sigma: Array, shape: Array | None = None) -> CommonCause:
    """Estimate of smallest variance; `differences`, `sigma`, `shape` (1 by default): (k,)."""
    shape = np.ones_like(differences) if shape is None else shape
    information = float(np.sum((shape / sigma) ** 2))
    amount = float(np.sum(shape * differences / sigma**2)) / information
    residual = (differences - amount * shape) / sigma
    return CommonCause(
        amount=amount,
        sigma=information**-0.5,
        without=float(np.sum((differences / sigma) ** 2)),
        remaining=float(residual @ residual),
        k=len(differences),
    )


@dataclass(frozen=True)
class Outlier:
    """The largest studentised residual: its row, t, and its p-value after Bonferroni."""

    row: int
    in_sigmas: float
    p_value: float


def largest_outlier(design: Array, observed: Array, sigma: Array) -> Outlier | None:
    """The reading that fits least; None for fewer than two degrees of freedom.

    Each residual is compared with the scatter of a fit without it, t = e / (s₍₋ᵢ₎ √(1 − h)), and
    its p-value is multiplied by the number of readings (mean shift model, Cook & Weisberg 1982).

    Parameters
    ----------
    design : (n, p); observed : (n,)
    sigma : (n,), in proportion to the noise of each row
    """
    own = basis(design / sigma[:, None])
    one_minus_leverage = 1 - np.sum(own**2, axis=1)
    degrees = len(observed) - own.shape[1] - 1
    tested = one_minus_leverage > MIN_ONE_MINUS_LEVERAGE
    if degrees < 1 or not tested.any():
        return None
    residual = observed / sigma - own @ (own.T @ (observed / sigma))
    share = np.where(tested, residual**2 / np.where(tested, one_minus_leverage, 1.0), 0.0)
    without = np.maximum(residual @ residual - share, np.finfo(float).tiny) / degrees
    t = np.sign(residual) * np.sqrt(share / without)
    row = int(np.argmax(np.abs(t)))
    p_value = normal_p_value(t[row], degrees) * int(tested.sum())
    return Outlier(row, float(t[row]), min(p_value, 1.0))


def outliers(design: Array, observed: Array, sigma: Array, level: float) -> list[Outlier]:
    """The outliers one after another, each tested after removal of the earlier ones.

    `level`: p-value after Bonferroni below which a reading is an outlier.
    """
    result: list[Outlier] = []
    kept = np.arange(len(observed))
    while True:
        outlier = largest_outlier(design[kept], observed[kept], sigma[kept])
        if outlier is None or outlier.p_value >= level:
            return result
        result.append(Outlier(int(kept[outlier.row]), outlier.in_sigmas, outlier.p_value))
        kept = np.delete(kept, outlier.row)
