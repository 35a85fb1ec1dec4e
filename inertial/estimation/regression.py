"""Regression of readings on one quantity: nested models, polynomials, two straight lines."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from inertial.arrays import Array
from inertial.estimation.probability import f_isf, f_sf, quadratic_ratio_sf

MIN_NEW_SHARE = 1e-6  # of a column's length: what is less lies in the other columns already
MAX_DEGREE = 3  # of a polynomial: models of temperature seldom have more
READINGS_PER_DEGREE = 3  # distinct abscissae, so that the noise can be estimated
MIN_READINGS_BESIDE_KNEE = 3
KNEE_GRID = 500  # places of a knee that are tried
KNEE_UNKNOWNS = 4
KNEE_CONFIDENCE = 0.95


@dataclass(frozen=True)
class NestedTest:
    """The F test of further columns in a model.

        F = (drop of the sum of squares / columns) / (residual sum of squares / degrees)

    The noise is estimated from the residuals, so its size need not be known.

    `values`, `sigma`: (q,), the coefficients, NaN where columns are collinear; `columns`:
    how many of them are new to the model; `degrees`: of freedom of the residuals; `scatter`: of
    these, in units of the sigmas given.
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
    return np.asarray(left[:, values > MIN_NEW_SHARE * values.max(initial=0.0)])


def nested_test(design: Array, columns: Array, observed: Array, sigma: Array) -> NestedTest | None:
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
    orthogonal = (whitened - own @ (own.T @ whitened)) / length
    residuals = observed / sigma - own @ (own.T @ (observed / sigma))
    left, values, right = np.linalg.svd(orthogonal, full_matrices=False)
    new = values > MIN_NEW_SHARE
    degrees = len(observed) - own.shape[1] - int(new.sum())
    if not new.any() or degrees < 1:
        return None
    along = left[:, new].T @ residuals
    drop = float(along @ along)
    variance = max(float(residuals @ residuals) - drop, 0.0) / degrees
    statistic = drop / int(new.sum()) / variance if variance else np.inf
    inverse = right[new].T / values[new]  # (q, new)
    determined = np.sum(right[new] ** 2, axis=0) > 1 - MIN_NEW_SHARE
    spread = np.sqrt(variance * np.sum(inverse**2, axis=1)) / length
    return NestedTest(
        values=np.where(determined, inverse @ along / length, np.nan),
        sigma=np.where(determined, spread, np.nan),
        statistic=statistic,
        columns=int(new.sum()),
        degrees=degrees,
        p_value=float(f_sf(statistic, int(new.sum()), degrees)),
        scatter=float(np.sqrt(variance)),
    )


@dataclass(frozen=True)
class Curve:
    """n readings in the order of the quantity x of which they are a function.

        reading = c₀ + c₁ P₁(x) + c₂ P₂(x) + c₃ P₃(x) + noise,   P: orthogonal over these readings

    The noise is estimated from the differences of each reading from the straight line between its
    two neighbours, any polynomial removed: so structure longer than three readings is no noise.
    Each c² is compared with it by F. Whether a polynomial fits is tested by its residuals against
    the scatter of neighbours (von Neumann 1941, Ann. Math. Statist. 12, 367): by noise alone the
    two are alike.

    `at`, `readings`: (n,); `basis`: (n, degrees + 1), orthonormal, of rising degree; `off`: (n, n),
    readings · off · readings is the noise of neighbours squared.
    """

    at: Array
    readings: Array
    basis: Array
    off: Array

    @property
    def degrees(self) -> range:
        """The degrees of a polynomial that so many readings determine."""
        return range(1, self.basis.shape[1])

    @property
    def highest(self) -> int:
        """The largest of them."""
        return self.degrees[-1]

    @cached_property
    def noise(self) -> float:
        """Standard deviation of a reading by its neighbours; at least the rounding error."""
        rounded = float(np.finfo(np.float64).eps * np.abs(self.readings).max())
        square = float(self.readings @ self.off @ self.readings)
        return float(np.sqrt(max(square, rounded**2)))

    @cached_property
    def freedom(self) -> float:
        """Degrees of freedom of the noise: fewer than differences, which share readings."""
        return float(np.trace(self.off) ** 2 / np.sum(self.off**2))

    @cached_property
    def amplitudes(self) -> Array:
        """c₀ …, (degrees + 1,)."""
        return np.asarray(self.basis.T @ self.readings)

    def drop(self, degrees: range) -> float:
        """Drop of chi-squared with these degrees, the noise being that of neighbours."""
        return float(np.sum(self.amplitudes[degrees.start : degrees.stop] ** 2)) / self.noise**2

    def p_value(self, degrees: range) -> float:
        """Probability of so large a drop by noise alone; 1 for no degrees."""
        if not degrees:
            return 1.0
        count = len(degrees)
        return float(f_sf(self.drop(degrees) / count, count, self.freedom))

    def residual_rms(self, degree: int) -> float:
        """Of the polynomial of this degree, root mean square per degree of freedom."""
        residual = self.readings - self.basis[:, : degree + 1] @ self.amplitudes[: degree + 1]
        return float(np.sqrt(residual @ residual / (len(residual) - degree - 1)))

    def residual_chi_squared(self) -> tuple[float, int]:
        """Chi-squared of the highest degree's residuals and its degrees of freedom."""
        freedom = len(self.at) - self.highest - 1
        return freedom * (self.residual_rms(self.highest) / self.noise) ** 2, freedom

    def misfit_p_value(self) -> float:
        """Probability that noise alone makes the highest degree's residuals exceed the noise so."""
        freedom = len(self.at) - self.highest - 1
        residuals = (np.eye(len(self.at)) - self.basis @ self.basis.T) / freedom
        return quadratic_ratio_sf(
            residuals, self.off, (self.residual_rms(self.highest) / self.noise) ** 2
        )

    def coefficients(self, degree: int, about: float) -> tuple[Array, Array]:
        """k₁ … of Σ k_j (x − about)^j and their sigmas, (degree,) each.

        The residuals count as noise, so a sigma is not too small where the polynomial misfits.
        """
        powers = np.vander(self.at - about, degree + 1, increasing=True)
        values = np.linalg.lstsq(powers, self.readings, rcond=None)[0]
        covariance = self.residual_rms(degree) ** 2 * np.linalg.inv(powers.T @ powers)
        return np.asarray(values[1:]), np.sqrt(np.diag(covariance))[1:]

    def slope(self, degree: int, at: float) -> float:
        """Of the polynomial of this degree, at one place."""
        return float(self.coefficients(degree, at)[0][0])


def curve_of(at: Array, readings: Array) -> Curve:
    """Readings, (n,), none empty, at six or more different places, in any order."""
    order = np.argsort(at, kind="stable")
    at, readings = at[order], readings[order]
    degrees = min(MAX_DEGREE, len(np.unique(at)) // READINGS_PER_DEGREE)
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


@dataclass(frozen=True)
class Knee:
    """Two straight lines that meet in a knee; fitted with as many unknowns as a cubic.

        reading = c + below · min(x − knee, 0) + above · max(x − knee, 0) + noise

    `between`: 95 % confidence interval of the knee; `slopes`, `sigmas`: below and above,
    marginalised over the knee; `residual_rms`: root mean square per degree of freedom, which
    counts as noise.
    """

    at: float
    between: tuple[float, float]
    slopes: tuple[float, float]
    sigmas: tuple[float, float]
    residual_rms: float

    @property
    def sigma(self) -> float:
        """Of its place, by the width of the interval."""
        return (self.between[1] - self.between[0]) / (2 * 1.96)


def knee_of(at: Array, readings: Array) -> Knee | None:
    """The knee of readings, (n,), that ascend in `at`; None where they are too few for one."""
    if (
        len(at) <= max(2 * MIN_READINGS_BESIDE_KNEE, KNEE_UNKNOWNS)
        or not at[MIN_READINGS_BESIDE_KNEE - 1] < at[-MIN_READINGS_BESIDE_KNEE]
    ):
        return None
    places = np.linspace(at[MIN_READINGS_BESIDE_KNEE - 1], at[-MIN_READINGS_BESIDE_KNEE], KNEE_GRID)
    squares = np.array([_fit(_lines(at, place), readings)[1] for place in places])
    best = int(np.argmin(squares))
    freedom = len(at) - KNEE_UNKNOWNS
    variance = squares[best] / freedom
    bar = squares[best] + variance * f_isf(1 - KNEE_CONFIDENCE, 1, freedom)
    inside = places[squares <= bar]
    knee = float(places[best])
    lines = _lines(at, knee)
    values, _ = _fit(lines, readings)
    # Derivative with respect to the knee.
    derivative = -np.where(at < knee, values[1], values[2])
    columns = np.column_stack([lines, derivative])
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
    """Least squares, and the sum of squared residuals."""
    values: Array = np.linalg.lstsq(columns, readings, rcond=None)[0].astype(np.float64)
    residuals = readings - columns @ values
    return values, float(residuals @ residuals)
