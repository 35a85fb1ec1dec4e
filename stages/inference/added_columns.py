"""Whether further columns explain what least squares leaves: the F test of nested models.

    F = (drop of the sum of squares / columns) / (what remains / degrees left)

The noise is judged by the residuals themselves, so its size need not be known.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.tails import ratio_beyond

Array = NDArray[np.float64]

NEW = 1e-6  # of a column's length: what is less is in the other columns already


@dataclass(frozen=True)
class Added:
    """What some columns explain beyond a model.

    `values`, `sigma`: (q,), the coefficients, NaN where columns cannot be told apart; `columns`:
    how many of them the model did not have; `degrees`: those left; `scatter`: of the residuals
    then, in units of the sigmas given.
    """

    values: Array
    sigma: Array
    statistic: float
    columns: int
    degrees: int
    p_value: float
    scatter: float


def basis(design: Array) -> Array:
    """Orthonormal columns that span those of a design, (n, rank)."""
    length = np.linalg.norm(design, axis=0)
    left, values, _ = np.linalg.svd(design / np.where(length > 0, length, 1.0), full_matrices=False)
    return np.asarray(left[:, values > NEW * values.max(initial=0.0)])


def added_columns(design: Array, columns: Array, observed: Array, sigma: Array) -> Added | None:
    """Add columns to a model; None where they are not new or leave no degree of freedom.

    Parameters
    ----------
    design : (n, p); columns : (n, q); observed : (n,)
    sigma : (n,), in proportion to the noise of each row
    """
    own = basis(design / sigma[:, None])
    whitened = columns / sigma[:, None]
    length = np.linalg.norm(whitened, axis=0)
    length = np.where(length > 0, length, 1.0)
    fresh = (whitened - own @ (own.T @ whitened)) / length
    rest = observed / sigma - own @ (own.T @ (observed / sigma))
    left, values, right = np.linalg.svd(fresh, full_matrices=False)
    new = values > NEW
    free = len(observed) - own.shape[1] - int(new.sum())
    if not new.any() or free < 1:
        return None
    along = left[:, new].T @ rest
    drop = float(along @ along)
    remains = max(float(rest @ rest) - drop, 0.0) / free
    statistic = drop / int(new.sum()) / remains if remains else np.inf
    inverse = right[new].T / values[new]  # (q, new)
    told = np.sum(right[new] ** 2, axis=0) > 1 - NEW
    spread = np.sqrt(remains * np.sum(inverse**2, axis=1)) / length
    return Added(
        values=np.where(told, inverse @ along / length, np.nan),
        sigma=np.where(told, spread, np.nan),
        statistic=statistic,
        columns=int(new.sum()),
        degrees=free,
        p_value=float(ratio_beyond(statistic, int(new.sum()), free)),
        scatter=float(np.sqrt(remains)),
    )
