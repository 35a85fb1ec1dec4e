"""What rests of unknown attitude leave open: combinations of parameters that no rest sees.

A combination is seen when the data narrow its vague prior, as one parameter is determined by
itself. Those that are not span what the principal axes of the covariance, in units of the priors,
have left wide; each parameter that lies in it most, one after another, stands for one of them. Of
the rests that could be added, the best is the one whose reading the combination changes most.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr

from stages.inference.free_positions import FREE, NAMES, PAIRS, PRIOR_SIGMA, matrix_of
from stages.inference.least_squares import NARROWED, Estimate

Array = NDArray[np.float64]

PART = 0.3  # of a combination: a parameter that has less of it is not named
SERVES = 0.9  # of the largest change: an attitude that reaches it serves as well as the best

# Faces, edges and corners of the case that point up: the simplest first.
ATTITUDES = np.array(
    sorted(
        (signs for signs in product((1, 0, -1), repeat=3) if any(signs)),
        key=lambda signs: (sum(map(abs, signs)), -sum(signs)),
    ),
    np.float64,
)


@dataclass(frozen=True)
class Unseen:
    """A combination that the rests do not tell, and the rest that would.

    `along`: (9,), of the parameters in units of their priors, of length 1; `up`: (3,), +1, 0 or −1
    for an axis that points up, lies level or points down.
    """

    along: Array
    up: Array

    @property
    def names(self) -> list[str]:
        """The parameters in it, the largest first."""
        order = np.argsort(-np.abs(self.along), kind="stable")
        return [NAMES[i] for i in order if abs(self.along[i]) >= PART]


def unseen(estimate: Estimate) -> list[Unseen]:
    """What an estimate of `free_positions` does not tell."""
    shrunk = estimate.covariance[:FREE, :FREE] / np.outer(PRIOR_SIGMA, PRIOR_SIGMA)
    variance, axes = np.linalg.eigh(shrunk)
    wide = axes[:, variance >= NARROWED**-2]
    within = wide @ wide.T
    order = qr(within, mode="r", pivoting=True)[1][: wide.shape[1]]
    changes = lengths(estimate) * PRIOR_SIGMA
    found = []
    for along in (within[:, order] / np.linalg.norm(within[:, order], axis=0)).T:
        told = np.abs(changes @ along)
        found.append(Unseen(along, ATTITUDES[int(np.argmax(told >= SERVES * told.max()))]))
    return found


def lengths(estimate: Estimate) -> Array:
    """By how much each parameter changes |P⁻¹ (reading − bias)| at the `ATTITUDES`, (26, 9)."""
    ups = ATTITUDES / np.linalg.norm(ATTITUDES, axis=1)[:, None]
    normal = ups @ np.linalg.inv(matrix_of(estimate.values))
    pairs = [
        normal[:, i] * ups[:, j] + (normal[:, j] * ups[:, i] if i != j else 0.0) for i, j in PAIRS
    ]
    return np.column_stack([*(estimate.values[-1] * pair for pair in pairs), normal])
