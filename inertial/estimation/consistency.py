"""Whether values agree within their sigmas: one by one, together, and outliers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import chi_squared_beyond, student_beyond
from inertial.estimation.regression import basis

# ---- Whether values agree within their sigmas, one by one and many together.


def chance_of(in_sigmas: float, degrees: float = np.inf) -> float:
    """Chance that a normal error is at least so many sigmas, either way.

    `degrees`: of freedom, where sigma is estimated (Student's t).
    """
    return float(2 * student_beyond(abs(in_sigmas), degrees))


def beyond_chance(p_values: Sequence[float], level: float) -> NDArray[np.bool_]:
    """Which of n comparisons differ, (n,), when one false alarm in all of them has chance `level`.

    The smallest p-value is held against level/n, the next one against level/(n − 1), until one
    is larger (Holm 1979).
    """
    p = np.asarray(p_values, dtype=np.float64)
    order = np.argsort(p)
    small = p[order] < level / np.arange(len(p), 0, -1)
    result = np.zeros(len(p), dtype=np.bool_)
    result[order] = np.logical_and.accumulate(small)
    return result


# ---- Whether differences that should be zero have one cause in common.
#
#     difference of axis i = amount · shape of axis i + noise
#
# The amount is that of smallest variance. What it leaves must be noise; what it explains must not.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SharedCause:
    """One amount for k differences, its sigma, and chi-squared without and with it."""

    amount: float
    sigma: float
    without: float  # of k degrees of freedom
    remaining: float  # of k − 1
    k: int

    @property
    def p_without(self) -> float:
        """Chance of such differences if there is no cause at all."""
        return float(chi_squared_beyond(self.without, self.k))

    @property
    def p_remaining(self) -> float:
        """Chance of what remains if this is the only cause; 1 where nothing can remain."""
        return float(chi_squared_beyond(self.remaining, self.k - 1)) if self.k > 1 else 1.0


def shared_cause(differences: Array, sigma: Array, shape: Array | None = None) -> SharedCause:
    """The amount of one cause; `differences`, `sigma`, `shape` (1 where left out): (k,)."""
    like = np.ones_like(differences) if shape is None else shape
    information = float(np.sum((like / sigma) ** 2))
    amount = float(np.sum(like * differences / sigma**2)) / information
    left = (differences - amount * like) / sigma
    return SharedCause(
        amount=amount,
        sigma=information**-0.5,
        without=float(np.sum((differences / sigma) ** 2)),
        remaining=float(left @ left),
        k=len(differences),
    )


# ---- Readings that do not belong to the others: studentised residuals after Bonferroni.
#
# Each residual is held against the scatter of a fit without it, t = e / (s₍₋ᵢ₎ √(1 − h)), and its
# chance is multiplied by the number of readings among which the largest was looked for
# (the mean shift model of Cook & Weisberg 1982).

ALONE = 1e-9  # 1 − leverage below which a reading has a column of its own and fits itself


@dataclass(frozen=True)
class Outlying:
    """The reading that stands out most: its row, t, and the chance after Bonferroni."""

    row: int
    in_sigmas: float
    p_value: float


def most_outlying(design: Array, observed: Array, sigma: Array) -> Outlying | None:
    """The reading that fits least; None where fewer than two degrees of freedom are left.

    Parameters
    ----------
    design : (n, p); observed : (n,)
    sigma : (n,), in proportion to the noise of each row
    """
    own = basis(design / sigma[:, None])
    free = 1 - np.sum(own**2, axis=1)
    degrees = len(observed) - own.shape[1] - 1
    judged = free > ALONE
    if degrees < 1 or not judged.any():
        return None
    rest = observed / sigma - own @ (own.T @ (observed / sigma))
    share = np.where(judged, rest**2 / np.where(judged, free, 1.0), 0.0)
    without = np.maximum(rest @ rest - share, np.finfo(float).tiny) / degrees
    t = np.sign(rest) * np.sqrt(share / without)
    row = int(np.argmax(np.abs(t)))
    chance = 2 * float(student_beyond(abs(t[row]), degrees))
    return Outlying(row, float(t[row]), min(chance * int(judged.sum()), 1.0))


def outliers(design: Array, observed: Array, sigma: Array, level: float) -> list[Outlying]:
    """The outlying readings, one after another, each judged after the earlier ones were left out.

    `level`: chance below which a reading, after Bonferroni, counts as outlying.
    """
    found: list[Outlying] = []
    kept = np.arange(len(observed))
    while True:
        one = most_outlying(design[kept], observed[kept], sigma[kept])
        if one is None or one.p_value >= level:
            return found
        found.append(Outlying(int(kept[one.row]), one.in_sigmas, one.p_value))
        kept = np.delete(kept, one.row)
