"""A formula of a source that is linear in the readings, with the covariance that it has.

    parameter k of sensor r = sum over j of weights[r, k, j] · reading[j, r]

The sources print such formulas without sigma. What the readings suffer is noise, each for itself,
and causes that several share: the tilt of a position, the angle of a turn, gravity.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

# Sensor by sensor three columns of M and the bias, (3, 4), in the order of the twelve unknowns.
ORDER = np.append(np.arange(12).reshape(3, 4)[:, :3].ravel(), np.arange(12).reshape(3, 4)[:, 3])


@dataclass(frozen=True)
class Solution:
    """M by rows, then the bias, (12,), and their covariance, (12, 12).

    NaN where a parameter is not determined.
    """

    values: Array
    covariance: Array

    @property
    def sigma(self) -> Array:
        """Standard deviations of the values, (12,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def determined(self) -> Booleans:
        """Which of the twelve are determined."""
        return np.isfinite(self.values)


@dataclass
class Readings:
    """n readings of three sensors, and all that they suffer.

    `values`: (n, 3); `noise`: (n, 3), standard deviations; NaN where not recorded. `causes`: for
    each error that several readings share, what it does to all of them at one sigma, (n, 3).
    """

    values: Array
    noise: Array
    causes: dict[tuple[str, str], Array] = field(default_factory=dict)

    def suffer(self, kind: str, name: str, reading: int, size: Array) -> None:
        """Let one sigma of the cause change a reading by `size`, (3,)."""
        if (kind, name) not in self.causes:
            self.causes[kind, name] = np.zeros_like(self.values)
        self.causes[kind, name][reading] += size

    def solution(self, weights: Array, determined: Booleans) -> Solution:
        """What the formula gives.

        Parameters
        ----------
        weights : (3, 4, n), zero where a reading is not recorded
        determined : (3, 4)
        """
        values = np.einsum("rkj,jr->rk", weights, np.nan_to_num(self.values)).ravel()[ORDER]
        noise = np.einsum("rkj,jr->rkj", weights, np.nan_to_num(self.noise))
        covariance = np.zeros((3, 4, 3, 4))
        for r in range(3):
            covariance[r, :, r, :] = noise[r] @ noise[r].T
        flat = covariance.reshape(12, 12)[np.ix_(ORDER, ORDER)]
        for size in self.causes.values():
            moved = np.einsum("rkj,jr->rk", weights, size).ravel()[ORDER]
            flat += np.outer(moved, moved)
        missing = ~determined.ravel()[ORDER]
        values[missing] = np.nan
        flat[missing[:, None] | missing[None, :]] = np.nan
        return Solution(values, flat)
