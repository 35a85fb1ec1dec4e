"""Static positions of unknown attitude whose specific force is longer or shorter than gravity.

    r = |A (reading − b)| − g,    A = P⁻¹ symmetric

fits all positions with few that are far off by the Cauchy loss, whose influence falls with r. Which
are off is then decided by least squares of the others, which do not leave so little by chance where
nine parameters can follow them: a position is off by many times what the others scatter by.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import least_squares

from inertial.arrays import Array, Booleans
from inertial.estimation.multi_position import PAIRS, PRIOR, PRIOR_SIGMA, matrix_of
from inertial.signal.scatter import MAD_TO_SIGMA, median

MIN_OFF_SIGMA = 10.0  # scatters of the others: more than a person's hand varies by
MIN_DEGREES = 18  # of freedom of the others, twice the parameters: by which their scatter is known
MAX_SHARE = 0.1  # of the positions: where more are off, it is how they scatter
FIRST_SCATTER = 0.01  # m/s², before it is known
ROUNDS = 5  # of the scatter, and of what is left out


@dataclass(frozen=True)
class OffLength:
    """A position by number: by how much |f| differs from gravity, and the others' scatter, m/s²."""

    number: int
    size: float
    scatter: float


def off_lengths(means: Array, sigma: Array, gravity: float) -> list[OffLength]:
    """The positions that are off; none where too few, or too many, would be.

    means, sigma : (n, 3), m/s²
    """
    n, unknowns = len(means), len(PRIOR)
    most = min(int(MAX_SHARE * n), n - unknowns - MIN_DEGREES)
    if most < 1:
        return []
    noise = np.sqrt(np.mean(sigma**2, axis=1))
    every = np.ones(n, bool)
    about, left = _fitted(means, gravity, every, PRIOR, FIRST_SCATTER, "linear")
    for _unused in range(ROUNDS):
        scatter = max(_scatter(left), float(np.median(noise)))
        about, left = _fitted(means, gravity, every, about, scatter, "cauchy")
    off = np.zeros(n, bool)
    for _unused in range(ROUNDS):
        scatter = max(_scatter(left), float(np.median(noise)))
        before, off = off, np.abs(left) > MIN_OFF_SIGMA * np.hypot(scatter, noise)
        if not 0 < np.count_nonzero(off) <= most:
            return []
        about, left = _fitted(means, gravity, ~off, about, scatter, "linear")
        if np.array_equal(before, off):
            break
    scatter = float(np.sqrt(np.sum(left[~off] ** 2) / (n - np.count_nonzero(off) - unknowns)))
    if np.abs(left[off]).min() < MIN_OFF_SIGMA * scatter:
        return []
    return [OffLength(i, float(left[i]), scatter) for i in np.flatnonzero(off).tolist()]


def _scatter(left: Array) -> float:
    return MAD_TO_SIGMA * float(median(np.abs(left)))


def _fitted(
    means: Array,
    gravity: float,
    used: Booleans,
    start: Array,
    scatter: float,
    loss: Literal["linear", "cauchy"],
) -> tuple[Array, Array]:
    """A and b, as P and bias, by those used, and what is left of all lengths, (n,), m/s².

    scatter : m/s², of the lengths
    loss : linear, or cauchy, by which a position counts less that is farther off
    """

    def lengths(about: Array) -> tuple[Array, Array]:
        vectors = (means - about[6:]) @ matrix_of(about)
        return vectors, np.linalg.norm(vectors, axis=1)

    def residual(about: Array) -> Array:
        return np.append(
            (lengths(about)[1][used] - gravity) / scatter, (about - PRIOR) / PRIOR_SIGMA
        )

    def jacobian(about: Array) -> Array:
        vectors, length = lengths(about)
        along, from_bias = vectors / length[:, None], means - about[6:]
        columns = [
            along[:, i] * from_bias[:, j] + (along[:, j] * from_bias[:, i] if i != j else 0.0)
            for i, j in PAIRS
        ]
        slopes = np.column_stack([*columns, -along @ matrix_of(about)])
        return np.vstack([slopes[used] / scatter, np.diag(1 / PRIOR_SIGMA)])

    found = least_squares(residual, start, jacobian, loss=loss, x_scale="jac").x
    return found, lengths(found)[1] - gravity
