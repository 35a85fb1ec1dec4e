"""Whether differences that should be zero have one cause in common.

    difference of axis i = amount · shape of axis i + noise

The amount is that of smallest variance. What it leaves must be noise; what it explains must not.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.tails import chi_squared_beyond

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
