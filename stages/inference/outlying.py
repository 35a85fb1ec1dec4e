"""Readings that do not belong to the others: studentised residuals after Bonferroni.

Each residual is held against the scatter of a fit without it, t = e / (s₍₋ᵢ₎ √(1 − h)), and its
chance is multiplied by the number of readings among which the largest was looked for
(the mean shift model of Cook & Weisberg 1982).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.added_columns import basis
from stages.inference.tails import student_beyond

Array = NDArray[np.float64]

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
