"""Sequential elimination of the errors of single positions, rate segments and stretches of time.

Equations are taken in their order. After the last equation with some errors, the rows that hold
them are made triangular: the first rows give these errors as functions of all other unknowns, and
are stored for the back substitution; the next hold errors that occur again, and stay pending; the
others hold none. So time and memory grow linearly with the number of stretches, and the remaining
rows hold only the unknowns that all stretches share (Bierman 1977, square-root information; George
& Heath 1980, orthogonal factors of sparse least squares).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dgeqrf, dormqr

from inertial.arrays import Array

Name = tuple[str, str]  # kind and name of an unknown

LAPACK_BLOCK = 64  # columns per block of reflectors
MAX_ROWS_PER_COLUMN = 4  # of the shared unknowns' rows, before they are compressed
MIN_ROWS_PER_FACTORISATION = 100  # fewer: more calls; more: more zeros


@dataclass(frozen=True)
class EquationBlock:
    """Equations in units of their sigma, about the priors of the shared unknowns.

    `rows`: (n, s + len(own) + 1), coefficients of the s shared unknowns, then of its `own` errors,
    then the observation. It represents `count` observations; `deviance`: 2 Σ log of their sigmas.
    """

    rows: Array
    own: tuple[Name, ...]
    count: int
    deviance: float


def r_factor(rows: Array) -> Array:
    """The triangular factor R of the rows: the same least-squares problem in fewest rows."""
    return np.asarray(np.linalg.qr(rows, mode="r"), dtype=np.float64)


def partial_r_factor(rows: Array, first: int) -> Array:
    """The same with only the first columns triangular: the rows below are zero there."""
    first = min(first, len(rows))
    if not first:
        return rows
    reflectors, sizes, *_ = dgeqrf(rows[:, :first])
    others = rows[:, first:]
    turned, *_ = dormqr("L", "T", reflectors, sizes, others, LAPACK_BLOCK * others.shape[1])
    return np.hstack([np.triu(reflectors), turned])


def compressed(rows: Array) -> Array:
    """The same equations in fewer rows, for more than two rows per column."""
    return r_factor(rows) if len(rows) > 2 * rows.shape[1] else rows


def whitened(rows: Array, sigma: Array, own: tuple[Name, ...]) -> EquationBlock:
    """Equations in units of their sigma, without channels that are not recorded."""
    there = np.isfinite(rows[:, -1]) & np.isfinite(sigma)
    deviance = 2 * float(np.sum(np.log(sigma[there])))
    return EquationBlock(rows[there] / sigma[there, None], own, int(there.sum()), deviance)


@dataclass(frozen=True)
class _BackSubstitution:
    """Rows that give f errors from the other unknowns: upper · errors + others · rest = right.

    `keys`: the f errors, then those eliminated later that occur in these rows.
    """

    keys: tuple[Name, ...]
    upper: Array  # (f, f)
    others: Array  # (f, later + s)
    right: Array  # (f,)


@dataclass(frozen=True)
class Eliminated:
    """The eliminated errors, and their contribution to the likelihood.

    `count`: of observations; `deviance`: of the sigmas and of the eliminated errors.
    """

    steps: Sequence[_BackSubstitution]
    sigma: Mapping[Name, float]
    count: int
    deviance: float

    @property
    def names(self) -> tuple[Name, ...]:
        """The errors, in the order of the back substitution."""
        return tuple(name for step in reversed(self.steps) for name in step.keys[: len(step.upper)])

    def estimate(self, shared: Array, covariance: Array) -> tuple[Array, Array]:
        """Values and sigmas of the errors, in the order of `names`.

        Parameters
        ----------
        shared, covariance : (s,), (s, s), estimate of the shared unknowns less their priors
        """
        values: list[Array] = []
        sigmas: list[Array] = []
        keys: tuple[Name, ...] = ()
        known = shared  # of the errors `keys`, then of the shared unknowns
        for step in reversed(self.steps):
            own = len(step.upper)
            place = {key: i for i, key in enumerate(keys)}
            kept = [place[key] for key in step.keys[own:]]
            kept += range(len(keys), len(known))
            known, covariance = known[kept], covariance[np.ix_(kept, kept)]
            inverse = solve_triangular(step.upper, np.eye(own))
            slope = -inverse @ step.others
            mixed = slope @ covariance
            corner = inverse @ inverse.T + mixed @ slope.T
            known = np.concatenate([inverse @ step.right + slope @ known, known])
            covariance = np.block([[corner, mixed], [mixed.T, covariance]])
            keys = step.keys
            scale = np.array([self.sigma.get(key, 1.0) for key in keys[:own]])
            values.append(known[:own] * scale)
            sigmas.append(np.sqrt(np.diag(corner)) * scale)
        empty = [np.zeros(0)]
        return np.concatenate(values or empty), np.concatenate(sigmas or empty)


def eliminate(
    blocks: Sequence[EquationBlock], shared: int, sigma: Mapping[Name, float]
) -> tuple[Array, Eliminated]:
    """Rows of the shared unknowns alone, (m, shared + 1), and the errors eliminated from them.

    `sigma`: prior sigma of each error, which is an observation of zero as well; an error without a
    prior sigma is known through the equations alone.
    """
    remaining = [np.zeros((0, shared + 1))]

    def keep(rows: Array) -> None:
        remaining.append(rows)
        if sum(map(len, remaining)) > MAX_ROWS_PER_COLUMN * (shared + 1):
            remaining[:] = [r_factor(np.vstack(remaining))]

    eliminated = eliminate_into(keep, blocks, shared, sigma)
    return np.vstack(remaining), eliminated


def eliminate_into(
    keep: Callable[[Array], None],
    blocks: Sequence[EquationBlock],
    shared: int,
    sigma: Mapping[Name, float],
) -> Eliminated:
    """The same; rows of the shared unknowns are handed to `keep`, some at a time."""
    last = {key: i for i, block in enumerate(blocks) for key in block.own}
    pending: list[tuple[tuple[Name, ...], Array]] = []
    rows = 0
    steps: list[_BackSubstitution] = []
    for i, block in enumerate(blocks):
        scaled = block.rows.copy()
        scaled[:, shared:-1] *= np.array([sigma.get(key, 1.0) for key in block.own])
        pending.append((block.own, scaled))
        rows += len(scaled)
        if rows < MIN_ROWS_PER_FACTORISATION and i < len(blocks) - 1:
            continue
        keys = dict.fromkeys(key for own, _ in pending for key in own)
        ready = [key for key in keys if last[key] <= i]
        later = tuple(key for key in keys if last[key] > i)
        own, every = len(ready), len(keys)
        stacked = _stacked(pending, (*ready, *later), ready, shared, sigma)
        tall = len(stacked) > stacked.shape[1]
        upper = r_factor(stacked) if tall else partial_r_factor(stacked, every)
        if own:
            step = (upper[:own, :own], upper[:own, own:-1], upper[:own, -1])
            steps.append(_BackSubstitution((*ready, *later), *step))
        rest = upper[own:every]
        pending = [(later, np.hstack([rest[:, every:-1], rest[:, own:every], rest[:, -1:]]))]
        keep(upper[every:, every:])
        rows = 0
    of_errors = sum(2 * float(np.sum(np.log(np.abs(np.diag(step.upper))))) for step in steps)
    count, deviance = sum(block.count for block in blocks), sum(block.deviance for block in blocks)
    return Eliminated(steps, sigma, count, of_errors + deviance)


def _stacked(
    pending: Sequence[tuple[tuple[Name, ...], Array]],
    keys: Sequence[Name],
    ready: Sequence[Name],
    shared: int,
    sigma: Mapping[Name, float],
) -> Array:
    """The rows of several blocks one below the other, with columns of `keys`, shared, observed."""
    place = {key: i for i, key in enumerate(keys)}
    zeros = [place[key] for key in ready if key in sigma]
    count = sum(len(rows) for _, rows in pending)
    stacked = np.zeros((count + len(zeros), len(keys) + shared + 1))
    row = 0
    for own, rows in pending:
        some = slice(row, row + len(rows))
        stacked[some, [place[key] for key in own]] = rows[:, shared:-1]
        stacked[some, len(keys) : -1] = rows[:, :shared]
        stacked[some, -1] = rows[:, -1]
        row += len(rows)
    stacked[count + np.arange(len(zeros)), zeros] = 1.0
    return stacked


# ---- The tilt of a set position: two unknowns at rest, more while the table turns.
#
# An error of the IMU on the table is fixed to its case, so a turn does not change it in body axes.
# An error of the table's axis, as of the outer axis of a two-axis table, is fixed to the
# laboratory, so in body axes it turns the other way. Which of the two a tilt t is, is not known. So
# the part l that is fixed to the laboratory has unknowns of its own, and in a turn by θ the
# accelerometers show
#
#     t + (R(θ) − 1) l,
#
# with the sigma of the table for t and for l, independently: that holds where the tilt is wholly of
# the case, and where it is wholly of the axis. The directions are the level ones of the start. In a
# turn about another axis than the vertical those of the case do not stay level, and an azimuth a of
# the case about the vertical of the start, of which nothing is seen there, becomes a tilt.
#
# Gyros show the part that is fixed to the case, for it moves the axis of the turn there. By
# themselves they know it to the same sigma; beside the accelerometers it is t − l.

TILTS = ("tilt 0", "tilt 1")  # t
OF_AXIS = ("tilt of axis 0", "tilt of axis 1")  # l
AZIMUTH = ("azimuth of case",)  # a
OF_CASE = ("tilt of case 0", "tilt of case 1")  # t − l


def names_of(positions: Sequence[str], kinds: Sequence[str]) -> tuple[Name, ...]:
    """The unknowns of these kinds of some positions."""
    return tuple((kind, position) for position in positions for kind in kinds)


def in_force(case: Array, laboratory: Array) -> Array:
    """The directions of t and l in what accelerometers show, (…, 4, 3), from level axes, (…, 2, 3).

    `case`: fixed to the case; `laboratory`: fixed to the laboratory, in body axes.
    """
    return np.concatenate([case, laboratory - case], axis=-2)


def case_by_both(positions: int) -> Array:
    """OF_CASE of some positions by their TILTS and OF_AXIS, (2 positions, 4 positions)."""
    return np.asarray(np.kron(np.eye(positions), np.hstack([np.eye(2), -np.eye(2)])))
