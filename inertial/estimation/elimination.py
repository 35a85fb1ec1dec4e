"""Least squares of many unknowns, most of which are errors of one position, turn or stretch.

Equations are taken in their order. When errors have been seen for the last time, the rows that hold
them are made triangular: the first of them then tell these errors once all else is known, and are
laid aside; the next hold errors that come again, and wait; the others hold none. So time and memory
grow as the number of stretches, and what is left are rows of the unknowns that all stretches share
(Bierman 1977, square-root information; George & Heath 1980, orthogonal factors of sparse least
squares).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dgeqrf, dormqr

Array = NDArray[np.float64]
Name = tuple[str, str]  # kind and name of an unknown

LAPACK_BLOCK = 64  # columns that are turned at once
MANY = 4  # rows for each column: with more of them those that are left are made fewer
TOGETHER = 100  # rows that are made triangular at once: fewer cost calls, more cost zeros


@dataclass(frozen=True)
class Part:
    """Equations in units of their sigma, about the priors of the shared unknowns.

    `rows`: (n, s + len(own) + 1), coefficients of the s shared unknowns, then of its `own` errors,
    then what was observed. It stands for `count` observations; `deviance`: 2 Σ log of their sigmas.
    """

    rows: Array
    own: tuple[Name, ...]
    count: int
    deviance: float


def triangle(rows: Array) -> Array:
    """The fewest rows that say the same in the sense of least squares."""
    return np.asarray(np.linalg.qr(rows, mode="r"), dtype=np.float64)


def led(rows: Array, first: int) -> Array:
    """The same with the first columns triangular alone: what is below says nothing of them."""
    first = min(first, len(rows))
    if not first:
        return rows
    reflectors, sizes, *_ = dgeqrf(rows[:, :first])
    others = rows[:, first:]
    turned, *_ = dormqr("L", "T", reflectors, sizes, others, LAPACK_BLOCK * others.shape[1])
    return np.hstack([np.triu(reflectors), turned])


def shorter(rows: Array) -> Array:
    """The same in fewer rows, where much is gained by it."""
    return triangle(rows) if len(rows) > 2 * rows.shape[1] else rows


@dataclass(frozen=True)
class _Told:
    """Rows that tell errors once all else is known: upper · errors + others · rest = right.

    `keys`: the errors that it tells, then those that are in it and told later.
    """

    keys: tuple[Name, ...]
    upper: Array  # (f, f)
    others: Array  # (f, later + s)
    right: Array  # (f,)


@dataclass(frozen=True)
class Apart:
    """The errors that were eliminated, and what they did to the likelihood.

    `count`: the observations; `deviance`: of the sigmas and of the eliminated errors.
    """

    told: Sequence[_Told]
    sigma: Mapping[Name, float]
    count: int
    deviance: float

    @property
    def names(self) -> tuple[Name, ...]:
        """The errors, in the order in which they are found."""
        return tuple(name for step in reversed(self.told) for name in step.keys[: len(step.upper)])

    def found(self, shared: Array, covariance: Array) -> tuple[Array, Array]:
        """Values and sigmas of the errors, in the order of `names`.

        Parameters
        ----------
        shared, covariance : (s,), (s, s), estimate of the shared unknowns less their priors
        """
        values: list[Array] = []
        sigmas: list[Array] = []
        keys: tuple[Name, ...] = ()
        about, spread = shared, covariance  # of the errors `keys`, then of the shared unknowns
        for step in reversed(self.told):
            own = len(step.upper)
            place = {key: i for i, key in enumerate(keys)}
            kept = [place[key] for key in step.keys[own:]]
            kept += range(len(keys), len(about))
            about, spread = about[kept], spread[np.ix_(kept, kept)]
            inverse = solve_triangular(step.upper, np.eye(own))
            slope = -inverse @ step.others
            mixed = slope @ spread
            corner = inverse @ inverse.T + mixed @ slope.T
            about = np.concatenate([inverse @ step.right + slope @ about, about])
            spread = np.block([[corner, mixed], [mixed.T, spread]])
            keys = step.keys
            width = np.array([self.sigma.get(key, 1.0) for key in keys[:own]])
            values.append(about[:own] * width)
            sigmas.append(np.sqrt(np.diag(corner)) * width)
        nothing = [np.zeros(0)]
        return np.concatenate(values or nothing), np.concatenate(sigmas or nothing)


def eliminated(
    parts: Sequence[Part], shared: int, sigma: Mapping[Name, float]
) -> tuple[Array, Apart]:
    """Rows of the shared unknowns alone, (m, shared + 1), and what was taken out of them.

    `sigma`: of the errors, each of which is an observation of zero as well; an error that is not
    there is known through the equations alone.
    """
    last = {key: i for i, part in enumerate(parts) for key in part.own}
    waiting: list[tuple[tuple[Name, ...], Array]] = []
    rows = 0
    free = [np.zeros((0, shared + 1))]
    told: list[_Told] = []
    for i, part in enumerate(parts):
        width = np.array([sigma.get(key, 1.0) for key in part.own])
        scaled = part.rows.copy()
        scaled[:, shared:-1] *= width
        waiting.append((part.own, scaled))
        rows += len(scaled)
        if rows < TOGETHER and i < len(parts) - 1:
            continue
        keys = dict.fromkeys(key for own, _ in waiting for key in own)
        ready = [key for key in keys if last[key] <= i]
        later = tuple(key for key in keys if last[key] > i)
        own, every = len(ready), len(keys)
        stacked = _stacked(waiting, (*ready, *later), ready, shared, sigma)
        tall = len(stacked) > stacked.shape[1]
        upper = triangle(stacked) if tall else led(stacked, every)
        if own:
            others = upper[:own, own:-1]
            told.append(_Told((*ready, *later), upper[:own, :own], others, upper[:own, -1]))
        rest = upper[own:every]
        waiting = [(later, np.hstack([rest[:, every:-1], rest[:, own:every], rest[:, -1:]]))]
        free.append(upper[every:, every:])
        if sum(map(len, free)) > MANY * (shared + 1):
            free = [triangle(np.vstack(free))]
        rows = 0
    of_errors = sum(2 * float(np.sum(np.log(np.abs(np.diag(step.upper))))) for step in told)
    count, deviance = sum(part.count for part in parts), sum(part.deviance for part in parts)
    return np.vstack(free), Apart(told, sigma, count, of_errors + deviance)


def _stacked(
    waiting: Sequence[tuple[tuple[Name, ...], Array]],
    keys: Sequence[Name],
    ready: Sequence[Name],
    shared: int,
    sigma: Mapping[Name, float],
) -> Array:
    """The rows of several parts one below the other, with columns of `keys`, shared, observed."""
    place = {key: i for i, key in enumerate(keys)}
    zeros = [place[key] for key in ready if key in sigma]
    count = sum(len(rows) for _, rows in waiting)
    stacked = np.zeros((count + len(zeros), len(keys) + shared + 1))
    row = 0
    for own, rows in waiting:
        some = slice(row, row + len(rows))
        stacked[some, [place[key] for key in own]] = rows[:, shared:-1]
        stacked[some, len(keys) : -1] = rows[:, :shared]
        stacked[some, -1] = rows[:, -1]
        row += len(rows)
    stacked[count + np.arange(len(zeros)), zeros] = 1.0
    return stacked
