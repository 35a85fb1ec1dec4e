"""The accelerometers from static positions of unknown attitude, by the magnitude of gravity."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Literal

import numpy as np
from scipy.linalg import qr
from scipy.optimize import least_squares
from scipy.special import stdtr, stdtrit

from inertial.arrays import Array, Booleans
from inertial.estimation.elimination import eliminate, whitened
from inertial.estimation.least_squares import (
    MIN_SIGMA_REDUCTION,
    Estimate,
    Stepped,
    counted,
    in_order,
    remaining,
    solve_stepped,
)
from inertial.physics.motion import level_axes
from inertial.signal.scatter import MAD_TO_SIGMA, median
from inertial.text.parameters import BIAS, SYMMETRIC

NAMES = (*SYMMETRIC, *BIAS)
FREE = len(NAMES)
PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))  # elements of P in the order of SYMMETRIC

# Vague priors: a scale factor within 1, the bias within 10 m/s², two axes within 0.1 rad of
# orthogonal, of which P has half: no triad is worse, and rests on faces, of which noise alone
# rotates the readings by σ/g, must not seem to determine it.
PRIOR = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
PRIOR_SIGMA = np.array([1.0, 1.0, 1.0, 0.05, 0.05, 0.05, 10.0, 10.0, 10.0])
HELD = 1e-3  # of its prior's sigma, for what is not determined while all else is estimated
SCATTER_RANGE = (1e-7, 1.0)  # m/s², between static positions beyond the noise
DIRECTION_SIGMA = 1.0  # rad, prior of a direction about that of the readings
MIN_COMPONENT = 0.3  # of an unobservable combination: a parameter with less is not listed
MIN_RELATIVE_EFFECT = 0.9  # of the largest change: an attitude that reaches it is as good


@dataclass(frozen=True)
class FreeRest:
    """A static position of unknown attitude: mean readings, m/s², and their sigma, (3,) each."""

    name: str
    mean: Array
    sigma: Array


@dataclass(frozen=True)
class Upward:
    """The upward directions of n rests as unknowns: two small components about a first value.

    `first`: (n, 3); `across`: (n, 2, 3), horizontal directions there.
    """

    first: Array
    across: Array

    def at(self, places: Array) -> tuple[Array, Array]:
        """The directions, (n, 3), and how they change per unit, (n, 2, 3), at `places`, (n, 2)."""
        vector = self.first + np.einsum("na,nai->ni", places, self.across)
        length = np.linalg.norm(vector, axis=1)[:, None]
        up = vector / length
        along = np.einsum("nai,ni->na", self.across, up)
        return up, (self.across - along[:, :, None] * up[:, None, :]) / length[:, :, None]


def upward_of(means: Array) -> Upward:
    """About the directions of uncalibrated readings, (n, 3)."""
    first = means / np.linalg.norm(means, axis=1)[:, None]
    return Upward(first, np.array([level_axes(up) for up in first]))


def matrix_of(parameters: Array) -> Array:
    """P from the first six of the parameters, (3, 3)."""
    xx, yy, zz, xy, xz, yz = parameters[:6]
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def free_positions(
    rests: Sequence[FreeRest], gravity: float, gravity_sigma: float, scatter: float = 0.0
) -> Estimate:
    """P by its elements xx, yy, zz, xy, xz, yz, and the bias, with all other unknowns.

        mean reading = P · (g v) + bias + noise,   |v| = 1

    Of the attitude nothing is known, only the magnitude of gravity: v is the upward direction at
    each rest, two unknowns of its own; so one equation of three remains,
    |P⁻¹ (reading − bias)| = g (Tedaldi, Pretto & Menegatti, ICRA 2014; the sum of squares here is
    that of the readings, each with its own sigma, so it is the likelihood maximised over v). n
    rests determine n combinations of nine parameters.

    Of M = P R they determine P and nothing of R, for a rotation of the triad against the case
    rotates all v alike. The convention is R = I: the axes are the orthogonal ones nearest to the
    sensors', and M = P is symmetric. That of imu_tk is M = P R upper triangular, with the same P:
    its inverse is T K of Tedaldi et al., with K diagonal and T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1].

    Noise across gravity lengthens a reading, |f|² = g² + …: this bias, σ²/g for equal channels, is
    subtracted, see `lengthened`. `scatter`, m/s²: between rests, beyond noise.

    What the rests do not determine is held at its prior while the sum of squares is made smallest:
    where no rest is inclined to an axis, a scale factor near 0 of it would fit any noise.
    """
    data = _Rests.of(rests, (gravity, gravity_sigma), scatter)
    start = np.concatenate([PRIOR, np.zeros(2 * len(rests)), [gravity]])
    held = data.holding(unobservable(data.linearised(start)[0].solve()))
    estimate = solve_stepped(held.linearised, held.squares, start)
    if held is not data:
        order = held.linearised(start)[1]
        free = data.linearised(in_order(estimate, order))[0].solve()
        estimate = replace(free, values=estimate.values)  # with what is known if nothing is held
    directions = dict.fromkeys(estimate.names[FREE + 1 :], DIRECTION_SIGMA)
    vague = dict(zip(estimate.names, PRIOR_SIGMA.tolist(), strict=False))
    return counted(estimate, {**vague, **directions})


@dataclass(frozen=True)
class _Rests:
    """n rests, the directions that their unknowns are about, and gravity with its sigma.

    The unknowns are P and bias, the directions, gravity. Each direction is in the equations of its
    own rest alone, from which it is eliminated: so time grows as n, not as n³.
    """

    rests: Sequence[FreeRest]
    up: Upward
    gravity: tuple[float, float]
    scatter: float
    prior_sigma: Array = field(default_factory=PRIOR_SIGMA.copy)

    def holding(self, combinations: "Sequence[Unobservable]") -> "_Rests":
        """The same with the parameters that represent these combinations at their priors."""
        if not combinations:
            return self
        sigma = self.prior_sigma.copy()
        for combination in combinations:
            sigma[NAMES.index(combination.names[0])] *= HELD
        return replace(self, prior_sigma=sigma)

    @classmethod
    def of(
        cls, rests: Sequence[FreeRest], gravity: tuple[float, float], scatter: float
    ) -> "_Rests":
        """About the directions of the readings."""
        return cls(rests, upward_of(np.array([rest.mean for rest in rests])), gravity, scatter)

    def squares(self, around: Array) -> float:
        """The sum of squares at given unknowns, (9 + 2 n + 1,), in units of their sigma."""
        _own, rest, sigma = _about(self.rests, self.up, self.scatter, around)
        prior = np.concatenate([PRIOR, np.zeros(2 * len(self.rests)), self.gravity[:1]])
        away = (around - prior) / np.concatenate(
            [self.prior_sigma, np.full(2 * len(self.rests), DIRECTION_SIGMA), self.gravity[1:]]
        )
        return float(np.sum((rest / sigma) ** 2) + away @ away)

    def linearised(self, around: Array) -> Stepped:
        """The equations linear about given unknowns, (9 + 2 n + 1,), and the order of these."""
        own, rest, sigma = _about(self.rests, self.up, self.scatter, around)
        places = around[FREE:-1].reshape(-1, 2)
        prior, shared = np.append(PRIOR, self.gravity[0]), np.append(around[:FREE], around[-1])
        observed = rest + own.shared @ (shared - prior)
        observed += np.einsum("nia,na->ni", own.directions, places)
        rows = np.concatenate([own.shared, own.directions, observed[:, :, None]], axis=2)
        names = [tuple((f"direction {i}", str(k)) for i in (0, 1)) for k in range(len(rows))]
        blocks = [whitened(*each) for each in zip(rows, sigma, names, strict=True)]
        errors = [name for pair in names for name in pair]
        left, eliminated = eliminate(blocks, len(prior), dict.fromkeys(errors, DIRECTION_SIGMA))
        parameters = tuple(("parameter", name) for name in NAMES)
        system = remaining(
            left,
            eliminated,
            prior,
            np.append(self.prior_sigma, self.gravity[1]),
            FREE,
            (*parameters, ("gravity", "")),
        )
        return system, (*parameters, *errors, ("gravity", ""))


@dataclass(frozen=True)
class _Own:
    """Coefficients of P, bias and gravity, (n, 3, 10), and of each rest's own direction."""

    shared: Array
    directions: Array  # (n, 3, 2)


def readings(
    rests: Sequence[FreeRest], up: Upward, scatter: float, around: Array
) -> tuple[Array, Array, Array]:
    """The readings as linear functions of the unknowns about `around`.

    Returns
    -------
    design (n, 3, 9 + 2 n + 1), observed (n, 3) and sigma (n, 3)
    """
    n = len(rests)
    own, rest, sigma = _about(rests, up, scatter, around)
    design, each = np.zeros((n, 3, FREE + 2 * n + 1)), np.arange(n)
    design[:, :, :FREE], design[:, :, -1] = own.shared[:, :, :FREE], own.shared[:, :, FREE]
    for a in (0, 1):
        design[each, :, FREE + 2 * each + a] = own.directions[:, :, a]
    return design, rest + design @ around, sigma


def _about(
    rests: Sequence[FreeRest], up: Upward, scatter: float, around: Array
) -> tuple[_Own, Array, Array]:
    """Coefficients, residuals (n, 3) and their sigma (n, 3) about given unknowns."""
    n = len(rests)
    matrix, bias, gravity = matrix_of(around), around[6:9], float(around[-1])
    directions, changes = up.at(around[FREE:-1].reshape(n, 2))
    along = directions @ matrix.T
    shared = np.zeros((n, 3, FREE + 1))
    for column, (i, j) in enumerate(PAIRS):
        shared[:, i, column] = gravity * directions[:, j]
        shared[:, j, column] = gravity * directions[:, i]
    shared[:, :, 6:9] = np.eye(3)
    shared[:, :, FREE] = along
    own = _Own(shared, gravity * np.einsum("nai,ji->nja", changes, matrix))
    sigma = np.hypot(np.array([rest.sigma for rest in rests]), scatter)
    increase = lengthened(matrix, directions, sigma, gravity)
    means = np.array([rest.mean for rest in rests]) - increase[:, None] * along
    return own, means - (gravity * along + bias), np.asarray(sigma)


def lengthened(matrix: Array, up: Array, sigma: Array, gravity: float) -> Array:
    """Increase of |P⁻¹ (reading − bias)| by noise, beyond that along its direction.

    To second order: with the covariance C of that vector, (tr C − |C v|²/(v·C v)) / (2 g), which is
    σ²/g for equal channels; (n,), m/s².
    """
    inverse = np.linalg.inv(matrix)
    covariance = np.einsum("ij,nj,kj->nik", inverse, sigma**2, inverse)
    across = np.einsum("nij,nj->ni", covariance, up)
    along_direction = np.sum(across**2, axis=1) / np.sum(across * up, axis=1)
    return np.asarray((np.trace(covariance, axis1=1, axis2=2) - along_direction) / (2 * gravity))


# Faces, edges and corners of the case that point up: the simplest first.
ATTITUDES = np.array(
    sorted(
        (signs for signs in product((1, 0, -1), repeat=3) if any(signs)),
        key=lambda signs: (sum(map(abs, signs)), -sum(signs)),
    ),
    np.float64,
)


@dataclass(frozen=True)
class Unobservable:
    """A combination that the rests do not determine, and the rest that would.

    `along`: (9,), of the parameters in units of their priors, of length 1; `up`: (3,), +1, 0 or −1
    for an axis that points up, lies level or points down.
    """

    along: Array
    up: Array

    @property
    def names(self) -> list[str]:
        """The parameters in it, the largest first."""
        order = np.argsort(-np.abs(self.along), kind="stable")
        return [NAMES[i] for i in order if abs(self.along[i]) >= MIN_COMPONENT]


def unobservable(estimate: Estimate) -> list[Unobservable]:
    """The unobservable combinations of an estimate of `free_positions`.

    A combination is observable when the data reduce its vague prior, as a single parameter is
    determined. The others are spanned by those principal axes of the covariance, in units of the
    priors, that keep their prior sigma; one after another, the parameter with the largest component
    in them represents one. Of the rests that could be added, the best is that whose reading the
    combination changes most.
    """
    shrunk = estimate.covariance[:FREE, :FREE] / np.outer(PRIOR_SIGMA, PRIOR_SIGMA)
    variance, axes = np.linalg.eigh(shrunk)
    unreduced = axes[:, variance >= MIN_SIGMA_REDUCTION**-2]
    within = unreduced @ unreduced.T
    order = qr(within, mode="r", pivoting=True)[1][: unreduced.shape[1]]
    changes = lengths(estimate) * PRIOR_SIGMA
    result = []
    for along in (within[:, order] / np.linalg.norm(within[:, order], axis=0)).T:
        effect = np.abs(changes @ along)
        result.append(
            Unobservable(
                along, ATTITUDES[int(np.argmax(effect >= MIN_RELATIVE_EFFECT * effect.max()))]
            )
        )
    return result


def lengths(estimate: Estimate) -> Array:
    """The change of |P⁻¹ (reading − bias)| per unit of each parameter at `ATTITUDES`, (26, 9)."""
    ups = ATTITUDES / np.linalg.norm(ATTITUDES, axis=1)[:, None]
    normal = ups @ np.linalg.inv(matrix_of(estimate.values))
    pairs = [
        normal[:, i] * ups[:, j] + (normal[:, j] * ups[:, i] if i != j else 0.0) for i, j in PAIRS
    ]
    return np.column_stack([*(estimate.values[FREE] * pair for pair in pairs), normal])


# ---- Static positions of unknown attitude whose specific force is longer or shorter than gravity.
#
#     r = |A (reading − b)| − g,    A = P⁻¹ symmetric
#
# fits all positions with few that are far off by the Cauchy loss, whose influence falls with r.
# Which are off is then decided by least squares of the others, which do not leave so little by
# chance where nine parameters can follow them: a position is off by many times what the others
# scatter by, and by more where few degrees of freedom tell how much that is.

MIN_OFF_SIGMA = 10.0  # scatters of the others, well known: more than a person's hand varies by
WELL_KNOWN_DEGREES = 18  # of freedom of the others; with fewer, as improbable of Student's t
MIN_DEGREES = 9  # as many as parameters
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
    degrees = n - int(np.count_nonzero(off)) - unknowns
    scatter = float(np.sqrt(np.sum(left[~off] ** 2) / degrees))
    if np.abs(left[off]).min() < _least_ratio(degrees) * scatter:
        return []
    return [OffLength(i, float(left[i]), scatter) for i in np.flatnonzero(off).tolist()]


def _least_ratio(degrees: int) -> float:
    """By how many scatters of the others a position is off, given their degrees of freedom."""
    few = min(degrees, WELL_KNOWN_DEGREES)
    return -float(stdtrit(few, stdtr(WELL_KNOWN_DEGREES, -MIN_OFF_SIGMA)))


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
