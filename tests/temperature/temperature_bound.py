"""The least sigma of parameters that are curves of the temperature (Cramér and Rao).

The blocks' exact physics and its derivatives are those of tests/bounds, at the temperature of each
block: a parameter θ(T) = θ + Σ c φ(T) has, for each c, the column of θ times φ. Nothing of the
model under test is used.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from block_statistics import ARC_SECOND, LEVER_ARM, Layout
from cramer_rao import known_rows

Array = np.ndarray


@dataclass(frozen=True)
class Curve:
    """One of the 24 parameters as a curve of z = (T − middle) / half.

    shape: the degree of a polynomial, or knee, a line whose slope changes at the knot, K.
    """

    parameter: int
    shape: str
    middle: float
    half: float
    knot: float = np.nan

    @property
    def count(self) -> int:
        """The number of coefficients; the knot is none."""
        return 2 if self.shape == "knee" else int(self.shape)

    def shapes(self, at: Array) -> Array:
        """What each coefficient is multiplied with at temperatures, K; zero at the middle."""
        z = (at - self.middle) / self.half
        if self.shape != "knee":
            return z[:, None] ** np.arange(1, self.count + 1)
        knot = (self.knot - self.middle) / self.half
        return np.column_stack([z, np.maximum(z - knot, 0) - max(-knot, 0)])

    def with_knot(self, at: Array, coefficients: Array) -> Array:
        """The same, and the derivative by the place of the knot, in units of z."""
        own = self.shapes(at)
        if self.shape != "knee":
            return own
        moved = -coefficients[-1] * (at > self.knot) + coefficients[-1] * (self.middle > self.knot)
        return np.column_stack([own, moved])


def inverse(information: Array) -> Array:
    """Of a symmetric matrix in units in which each unknown alone has 1; a huge sigma of those that
    are not shown.
    """
    size = np.sqrt(np.abs(np.diag(information)))
    size[size == 0] = 1.0
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    values = np.where(values > 1e-12, values, 1e-12)
    return np.asarray((vectors / values) @ vectors.T / np.outer(size, size))


class Bound:
    """The bound of a plan whose blocks are at known temperatures, K."""

    def __init__(
        self, layout: Layout, temperature: Array, gyro: float, accelerometer: float
    ) -> None:
        """gyro, accelerometer: white noise, °/√h and m/s/√h."""
        self.layout, self.temperature = layout, temperature
        self._density = np.repeat([accelerometer / 60, np.radians(gyro) / 60], 3)

    @cached_property
    def _jacobian(self) -> Array:
        """By the unknowns of the layout, (blocks, 6, n)."""
        layout = self.layout
        truth, known = layout.truth(), layout.known
        step = np.where(known == LEVER_ARM, 1e-2, ARC_SECOND)
        step[:9] = step[12:21] = 1e-5
        step[9:12], step[21:24] = 1e-4, 1e-7
        return np.stack(
            [
                (layout.read(truth + one) - layout.read(truth - one)) / (2 * step[i])
                for i, one in enumerate(np.diag(step))
            ],
            axis=-1,
        )

    @cached_property
    def rows(self) -> Array:
        """The same in units of the noise of what is known, (m, n)."""
        return known_rows(self.layout, self._jacobian, self._density)

    def covariance(self, shapes: Sequence[tuple[int, Array]]) -> Array:
        """Of the 24 parameters at the middle, then the coefficients of (parameter, shapes) each.

        shapes: of the coefficients, (blocks, k). Table errors are eliminated.
        """
        n = len(self.layout.known)
        rows = np.hstack([self.rows, *(self.rows_of(p, s) for p, s in shapes)])
        information = rows.T @ rows
        information[np.arange(n), np.arange(n)] += np.nan_to_num(1 / self.layout.known**2)
        spread = inverse(information)
        kept = [*range(24), *range(n, len(spread))]
        return np.asarray(spread[np.ix_(kept, kept)])

    def rows_of(self, parameter: int, shapes: Array) -> Array:
        """The columns of the coefficients of a parameter, (m, k)."""
        columns = self._jacobian[:, :, [parameter]] * shapes[:, None]
        return known_rows(self.layout, columns, self._density)

    @cached_property
    def _constant(self) -> Array:
        """Covariance of all unknowns where no parameter is a curve, (n, n)."""
        return inverse(self.rows.T @ self.rows + np.diag(np.nan_to_num(1 / self.layout.known**2)))

    def alone(self, curve: Curve) -> Array:
        """Sigmas of the coefficients of the only curve of a campaign, (k,), its knot known."""
        own = self.rows_of(curve.parameter, curve.shapes(self.temperature))
        shared = self.rows.T @ own
        left = own.T @ own - shared.T @ self._constant @ shared
        return np.asarray(np.sqrt(np.diag(inverse(left))))

    def sigmas(self, curves: Sequence[Curve]) -> Array:
        """Of the 24 parameters at the middle and the coefficients of curves, knots known."""
        shapes = [(c.parameter, c.shapes(self.temperature)) for c in curves]
        return np.sqrt(np.diag(self.covariance(shapes)))

    def of_curves(self, curves: Sequence[Curve], coefficients: Sequence[Array], at: Array) -> Array:
        """Sigma of each of the 24 parameters at temperatures, K, knots not known; (24, k)."""
        told = list(zip(curves, coefficients, strict=True))
        blocks = [(c.parameter, c.with_knot(self.temperature, n)) for c, n in told]
        covariance = self.covariance(blocks)
        sigma: Array = np.sqrt(np.repeat(np.diag(covariance)[:24, None], len(at), axis=1))
        start = 24
        for curve, numbers in told:
            own = curve.with_knot(at, numbers)
            places = [curve.parameter, *range(start, start + own.shape[1])]
            start += own.shape[1]
            design = np.column_stack([np.ones(len(at)), own])
            own_covariance = covariance[np.ix_(places, places)]
            variance = np.einsum("ti,ij,tj->t", design, own_covariance, design)
            sigma[curve.parameter] = np.sqrt(variance)
        return sigma
