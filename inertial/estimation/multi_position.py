"""The accelerometers from static positions of unknown attitude, by the magnitude of gravity."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr, rq

from inertial.estimation.least_squares import MIN_SIGMA_REDUCTION, Estimate, System, solve_iterated
from inertial.estimation.triad import BIAS, SYMMETRIC
from inertial.physics.motion import level_axes

# ---- The accelerometers from rests of unknown attitude: known is only how large gravity is.
#
#     mean reading = P · (g v) + bias + noise,   |v| = 1
#
# v is the upward direction at each rest, two unknowns of its own that its three readings tell;
# the third reading is the equation that is left, |P⁻¹ (reading − bias)| = g (Tedaldi, Pretto &
# Menegatti, ICRA 2014; the sum of squares here is that of the readings, each with its own sigma,
# so it is the likelihood with v at its best). So n rests tell n combinations of nine parameters.
#
# Of M = P R they tell P and nothing of R, for a rotation of the triad against the case turns all
# v alike. The convention is R = I: the axes are those square to each other that lie nearest to
# the sensors', and M = P is symmetric. That of imu_tk is that the z sensor feels z alone and the
# y sensor no x: M upper triangular, with the same P; see `upper_triangular`.
#
# Noise across gravity makes a reading longer, |f|² = g² + …: what that adds, σ²/g for alike
# channels, is taken off.

Array = NDArray[np.float64]

NAMES = (*SYMMETRIC, *BIAS)
FREE = len(NAMES)
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # elements of P in the order of SYMMETRIC

# Vague priors: a scale factor within 1, the bias within 10 m/s², two axes within 0.1 rad of square,
# of which P has half: no triad is made worse, and rests on faces, of which noise alone turns the
# readings by σ/g, must not seem to tell it.
PRIOR = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
PRIOR_SIGMA = np.array([1.0, 1.0, 1.0, 0.05, 0.05, 0.05, 10.0, 10.0, 10.0])
ANY = 1.0  # rad, of a direction about the one that the readings show


@dataclass(frozen=True)
class FreeRest:
    """A rest of unknown attitude: mean readings, m/s², and their sigma, (3,) each."""

    name: str
    mean: Array
    sigma: Array


@dataclass(frozen=True)
class Upward:
    """The upward directions of n rests as unknowns: two small numbers beside a first guess.

    `first`: (n, 3); `across`: (n, 2, 3), level directions there.
    """

    first: Array
    across: Array

    def at(self, places: Array) -> tuple[Array, Array]:
        """The directions, (n, 3), and how they change per unit, (n, 2, 3), at `places`, (n, 2)."""
        long = self.first + np.einsum("na,nai->ni", places, self.across)
        length = np.linalg.norm(long, axis=1)[:, None]
        up = long / length
        along = np.einsum("nai,ni->na", self.across, up)
        return up, (self.across - along[:, :, None] * up[:, None, :]) / length[:, :, None]


def upward_of(means: Array) -> Upward:
    """About the directions that readings show which are taken as they are, (n, 3)."""
    first = means / np.linalg.norm(means, axis=1)[:, None]
    return Upward(first, np.array([level_axes(up) for up in first]))


def matrix_of(parameters: Array) -> Array:
    """P from the first six of the parameters, (3, 3)."""
    xx, yy, zz, xy, xz, yz = parameters[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def free_positions(
    rests: Sequence[FreeRest], gravity: float, gravity_sigma: float, scatter: float = 0.0
) -> Estimate:
    """P by its elements xx, yy, zz, xy, xz, yz, and the bias, with all that is unknown beside them.

    `scatter`, m/s², is by what the readings differ from rest to rest beyond noise.
    """
    up = upward_of(np.array([rest.mean for rest in rests]))
    about = partial(equations, rests, up, (gravity, gravity_sigma), scatter)
    return solve_iterated(about, np.concatenate([PRIOR, np.zeros(2 * len(rests)), [gravity]]))


def equations(
    rests: Sequence[FreeRest],
    up: Upward,
    gravity: tuple[float, float],
    scatter: float,
    around: Array,
) -> System:
    """The equations of all rests, linear about `around`, (9 + 2 n + 1,).

    Unknowns: P and bias, the directions, gravity, whose value and sigma are given.
    """
    n = len(rests)
    names = [("parameter", name) for name in NAMES]
    names += [(f"direction {i}", rest.name) for rest in rests for i in (0, 1)]
    names += [("gravity", "")]
    design, observed, sigma = readings(rests, up, scatter, around)
    return System(
        design.reshape(3 * n, -1),
        observed.ravel(),
        sigma.ravel(),
        np.concatenate([PRIOR, np.zeros(2 * n), gravity[:1]]),
        np.concatenate([PRIOR_SIGMA, np.full(2 * n, ANY), gravity[1:]]),
        FREE + 2 * n,
        tuple(names),
    )


def readings(
    rests: Sequence[FreeRest], up: Upward, scatter: float, around: Array
) -> tuple[Array, Array, Array]:
    """What every reading sees of the unknowns about `around`.

    Returns
    -------
    design (n, 3, 9 + 2 n + 1), observed (n, 3) and sigma (n, 3)
    """
    n = len(rests)
    matrix, bias, gravity = matrix_of(around), around[6:9], float(around[-1])
    directions, changes = up.at(around[FREE:-1].reshape(n, 2))
    along = directions @ matrix.T
    design = np.zeros((n, 3, FREE + 2 * n + 1))
    for column, (i, j) in enumerate(PAIRS):
        design[:, i, column] = gravity * directions[:, j]
        design[:, j, column] = gravity * directions[:, i]
    design[:, :, 6:9] = np.eye(3)
    each = np.arange(n)
    for a in (0, 1):
        design[each, :, FREE + 2 * each + a] = gravity * changes[:, a] @ matrix.T
    design[:, :, -1] = along
    sigma = np.hypot(np.array([rest.sigma for rest in rests]), scatter)
    longer = lengthened(matrix, directions, sigma, gravity)
    means = np.array([rest.mean for rest in rests]) - longer[:, None] * along
    rest = means - (gravity * along + bias)
    return design, rest + design @ around, np.asarray(sigma)


def lengthened(matrix: Array, up: Array, sigma: Array, gravity: float) -> Array:
    """By how much noise lengthens each P⁻¹ (reading − bias) beyond what its direction takes up.

    To second order: with the covariance C of that vector, (tr C − |C v|²/(v·C v)) / (2 g), which is
    σ²/g for alike channels; (n,), m/s².
    """
    inverse = np.linalg.inv(matrix)
    spread = np.einsum("ij,nj,kj->nik", inverse, sigma**2, inverse)
    across = np.einsum("nij,nj->ni", spread, up)
    taken = np.sum(across**2, axis=1) / np.sum(across * up, axis=1)
    return np.asarray((np.trace(spread, axis1=1, axis2=2) - taken) / (2 * gravity))


def upper_triangular(symmetric: Array) -> Array:
    """The same triad as imu_tk has it: M = P R upper triangular, (3, 3).

    Its inverse is T K of Tedaldi et al., truth = T K (reading − bias) with K diagonal and
    T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1].
    """
    upper = np.asarray(rq(symmetric, mode="r"))
    return np.asarray(upper * np.sign(np.diag(upper)))


# ---- What rests of unknown attitude leave open: combinations of parameters that no rest sees.
#
# A combination is seen when the data narrow its vague prior, as one parameter is determined by
# itself. Those that are not span what the principal axes of the covariance, in units of the
# priors, have left wide; each parameter that lies in it most, one after another, stands for one
# of them. Of the rests that could be added, the best is the one whose reading the combination
# changes most.

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
    wide = axes[:, variance >= MIN_SIGMA_REDUCTION**-2]
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
