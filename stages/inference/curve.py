"""Readings against one quantity, such as the temperature: along which polynomial they go.

    reading = c₀ + c₁ P₁(x) + c₂ P₂(x) + c₃ P₃(x) + noise,    P: orthogonal over these readings

Nothing is known of the noise beforehand, so it is taken from neighbours: by how much a reading is
off the straight line between the two beside it, all that a law could be taken out. So what is
wider than three readings is no noise. Each c² is held against it by F.

Whether a polynomial holds the readings is told by what it leaves, against the scatter of
neighbours (von Neumann 1941, Ann. Math. Statist. 12, 367): by noise alone the two are alike.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stages.inference.ratio_of_squares import chance_of_ratio
from stages.inference.tails import ratio_beyond

Array = NDArray[np.float64]

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
        return float(ratio_beyond(self.drop(degrees) / count, count, self.freedom))

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
        return chance_of_ratio(rest, self.off, (self.left(self.highest) / self.noise) ** 2)

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
