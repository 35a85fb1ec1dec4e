"""Regression of readings on one quantity: nested models, polynomials, two straight lines."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.probability import f_isf, f_sf, quadratic_ratio_sf

# ---- Whether further columns explain what least squares leaves: the F test of nested models.
#
#     F = (drop of the sum of squares / columns) / (what remains / degrees left)
#
# The noise is judged by the residuals themselves, so its size need not be known.

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
        p_value=float(f_sf(statistic, int(new.sum()), free)),
        scatter=float(np.sqrt(remains)),
    )


# ---- Readings against one quantity, such as the temperature: along which polynomial they go.
#
#     reading = c₀ + c₁ P₁(x) + c₂ P₂(x) + c₃ P₃(x) + noise,    P: orthogonal over these readings
#
# Nothing is known of the noise beforehand, so it is taken from neighbours: by how much a reading
# is off the straight line between the two beside it, all that a law could be taken out. So what
# is wider than three readings is no noise. Each c² is held against it by F.
#
# Whether a polynomial holds the readings is told by what it leaves, against the scatter of
# neighbours (von Neumann 1941, Ann. Math. Statist. 12, 367): by noise alone the two are alike.

HIGHEST = 3  # degree of a law: what models of temperature usually have, and calibrations can hold
READINGS = 3  # for each degree, so that noise is left to be seen


@dataclass(frozen=True)
class Curve:
    """n readings in the order of what they are a function of.

    `at`, `readings`: (n,); `basis`: (n, degrees + 1), orthonormal, of rising degree; `off`: (n, n),
    readings · off · readings is the noise of neighbours squared.
    """

    at: Array
    readings: Array
    basis: Array
    off: Array

    @property
    def lawful(self) -> range:
        """The degrees of a law that so many readings can tell."""
        return range(1, self.basis.shape[1])

    @property
    def highest(self) -> int:
        """The largest of them."""
        return self.lawful[-1]

    @cached_property
    def noise(self) -> float:
        """Of one reading, its standard deviation by the neighbours; at least what is rounded."""
        rounded = float(np.finfo(np.float64).eps * np.abs(self.readings).max())
        square = float(self.readings @ self.off @ self.readings)
        return float(np.sqrt(max(square, rounded**2)))

    @cached_property
    def freedom(self) -> float:
        """Degrees of freedom of the noise: differences share readings, so fewer than they are."""
        return float(np.trace(self.off) ** 2 / np.sum(self.off**2))

    @cached_property
    def amplitudes(self) -> Array:
        """c₀ …, (degrees + 1,)."""
        return np.asarray(self.basis.T @ self.readings)

    def drop(self, degrees: range) -> float:
        """Drop of chi-squared with these degrees, the noise being that of neighbours."""
        return float(np.sum(self.amplitudes[degrees.start : degrees.stop] ** 2)) / self.noise**2

    def chance(self, degrees: range) -> float:
        """Chance that noise alone brings forth so large a drop; 1 where there are no degrees."""
        if not degrees:
            return 1.0
        count = len(degrees)
        return float(f_sf(self.drop(degrees) / count, count, self.freedom))

    def left(self, degree: int) -> float:
        """What the polynomial of this degree leaves, root of the mean square per freedom."""
        rest = self.readings - self.basis[:, : degree + 1] @ self.amplitudes[: degree + 1]
        return float(np.sqrt(rest @ rest / (len(rest) - degree - 1)))

    def left_chi_squared(self) -> tuple[float, int]:
        """What the highest degree leaves, in variances of the noise, and its degrees of freedom."""
        freedom = len(self.at) - self.highest - 1
        return freedom * (self.left(self.highest) / self.noise) ** 2, freedom

    def chance_beyond(self) -> float:
        """Chance that noise alone is left by the highest degree, so much above its neighbours'."""
        freedom = len(self.at) - self.highest - 1
        rest = (np.eye(len(self.at)) - self.basis @ self.basis.T) / freedom
        return quadratic_ratio_sf(rest, self.off, (self.left(self.highest) / self.noise) ** 2)

    def coefficients(self, degree: int, about: float) -> tuple[Array, Array]:
        """k₁ … of Σ k_j (x − about)^j and their sigmas, (degree,) each.

        What the polynomial leaves counts as noise, so a sigma is none too small where it misfits.
        """
        powers = np.vander(self.at - about, degree + 1, increasing=True)
        values = np.linalg.lstsq(powers, self.readings, rcond=None)[0]
        covariance = self.left(degree) ** 2 * np.linalg.inv(powers.T @ powers)
        return np.asarray(values[1:]), np.sqrt(np.diag(covariance))[1:]

    def slope(self, degree: int, at: float) -> float:
        """Of the polynomial of this degree, at one place."""
        return float(self.coefficients(degree, at)[0][0])


def curve_of(at: Array, readings: Array) -> Curve:
    """Readings, (n,), none empty, at six or more different places, in any order."""
    order = np.argsort(at, kind="stable")
    at, readings = at[order], readings[order]
    degrees = min(HIGHEST, len(np.unique(at)) // READINGS)
    along = 2 * (at - at[0]) / (at[-1] - at[0]) - 1
    basis = np.linalg.qr(np.polynomial.legendre.legvander(along, degrees))[0]
    off = _off_neighbours(at) @ (np.eye(len(at)) - basis @ basis.T)
    squares = off.T @ off
    return Curve(at, readings, basis, squares / np.trace(squares))


def _off_neighbours(at: Array) -> Array:
    """How far each reading is off the line between its neighbours, (n − 2, n), rows of length 1."""
    n = len(at)
    before, behind = at[1:-1] - at[:-2], at[2:] - at[1:-1]
    apart = before + behind
    share = np.divide(before, apart, out=np.full(n - 2, 0.5), where=apart > 0)
    rows, places = np.zeros((n - 2, n)), np.arange(n - 2)
    rows[places, places] = share - 1
    rows[places, places + 1] = 1.0
    rows[places, places + 2] = -share
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


# ---- Two straight lines that meet in a knee, fitted to readings against one quantity.
#
#     reading = c + below · min(x − knee, 0) + above · max(x − knee, 0) + noise
#
# It has four unknowns, as many as a cubic, so the two are compared by what they leave.

BESIDE = 3  # readings on either side of a knee, at least
PLACES = 500  # that are tried
UNKNOWNS = 4
CONFIDENCE = 0.95


@dataclass(frozen=True)
class Knee:
    """The likeliest knee.

    `between`: where it is with 95 % confidence; `slopes`, `sigmas`: below and above, wherever in
    reach the knee is; `left`: what the lines leave, root of the mean square per freedom, which
    counts as noise.
    """

    at: float
    between: tuple[float, float]
    slopes: tuple[float, float]
    sigmas: tuple[float, float]
    left: float

    @property
    def sigma(self) -> float:
        """Of its place, as wide as the interval."""
        return (self.between[1] - self.between[0]) / (2 * 1.96)


def knee_of(at: Array, readings: Array) -> Knee | None:
    """The knee of readings, (n,), that ascend in `at`; None where they are too few for one."""
    if len(at) <= max(2 * BESIDE, UNKNOWNS) or not at[BESIDE - 1] < at[-BESIDE]:
        return None
    places = np.linspace(at[BESIDE - 1], at[-BESIDE], PLACES)
    squares = np.array([_fit(_lines(at, place), readings)[1] for place in places])
    best = int(np.argmin(squares))
    freedom = len(at) - UNKNOWNS
    variance = squares[best] / freedom
    bar = squares[best] + variance * f_isf(1 - CONFIDENCE, 1, freedom)
    inside = places[squares <= bar]
    knee = float(places[best])
    lines = _lines(at, knee)
    values, _ = _fit(lines, readings)
    # A knee that moves takes the line that it leaves with it.
    moved = -np.where(at < knee, values[1], values[2])
    columns = np.column_stack([lines, moved])
    covariance = variance * np.linalg.pinv(columns.T @ columns)
    below, above = np.sqrt(np.diag(covariance))[1:3].tolist()
    return Knee(
        knee,
        (float(inside[0]), float(inside[-1])),
        (float(values[1]), float(values[2])),
        (below, above),
        float(np.sqrt(variance)),
    )


def _lines(at: Array, knee: float) -> Array:
    away = at - knee
    return np.column_stack([np.ones(len(at)), np.minimum(away, 0.0), np.maximum(away, 0.0)])


def _fit(columns: Array, readings: Array) -> tuple[Array, float]:
    """Least squares, and the sum of the squares that are left."""
    values: Array = np.linalg.lstsq(columns, readings, rcond=None)[0].astype(np.float64)
    rest = readings - columns @ values
    return values, float(rest @ rest)
