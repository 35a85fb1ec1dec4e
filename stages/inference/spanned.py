"""Least squares as the sources print it, [M | b] = L Aᵀ (A Aᵀ)⁻¹, where A may not be spanned.

A Aᵀ can be inverted only where the inputs span all rows of A. S4 turned each gyro about its own
axis alone, so what was used of its inputs has rank 2 of 4; it permuted them until the matrix could
be inverted, and found cross terms that no data had shown. Here the inverse is that of the part that
is spanned, and what lies outside of it is not determined.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

SEEN = 1e-3  # of the strongest combination of inputs; a weaker one would show its errors 1000-fold
OUTSIDE = 1e-6  # share of a column that may lie outside of what is spanned


@dataclass(frozen=True)
class Spanned:
    """The inverse of a design, its rank, and the columns that it determines.

    `inverse`: (q, n), so that unknowns = inverse · observations; `determined`: (q,).
    """

    inverse: Array
    rank: int
    determined: Booleans


def spanned(design: Array) -> Spanned:
    """Invert a design of n observations and q unknowns, (n, q), of any rank.

    The columns count in units of their own length, so their units do not matter.
    """
    length = np.linalg.norm(design, axis=0)
    unit = np.where(length > 0, length, 1.0)
    left, values, right = np.linalg.svd(design / unit, full_matrices=False)
    seen = values > SEEN * values.max(initial=0.0)
    inverse = (right[seen].T / values[seen]) @ left[:, seen].T / unit[:, None]
    outside = 1 - np.sum(right[seen] ** 2, axis=0)
    return Spanned(inverse, int(seen.sum()), np.asarray(outside < OUTSIDE))
