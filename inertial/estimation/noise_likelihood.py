"""The likelihood of the terms of the noise of one channel, and its maxima.

Squares of cosine coefficients in a bin are chi-squared about the density that the terms add up to;
the lowest coefficients are Gaussian with the covariance of the terms and, as their mean, a ramp.
The deviance is −2 log of the restricted likelihood: with a ramp, its slope is integrated out
(REML), so that the random walk does not lose what the slope absorbs.

Source: W. A. Fuller, Measurement error models, 1987, and D. A. Harville, JASA 72, 1977, 320, for
REML and scoring; P. Whittle, Ark. Mat. 2, 1953, 423, for the densities.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import nnls

from inertial.arrays import Array, Booleans
from inertial.estimation.multiresolution import Bins, Lowest

MAX_STEPS = 60
TOLERANCE = 1e-5  # of the deviance
MAX_HALVINGS = 30
FAR = 6.0  # sigma from zero: an interval does not reach it
END_TOLERANCE = 0.005  # of an end of an interval, in sigma


@dataclass(frozen=True, eq=False)
class Fit:
    """A maximum of the likelihood.

    variances: (4,), squares of the stochastic coefficients, 0 where absent; free: those that were
    estimated; information: (f, f), of the free variances above 0, `inside`; deviance; slope, its
    variance, and the degrees of freedom of that: of the ramp, 0, 0, inf without one.
    """

    variances: Array
    inside: tuple[int, ...]
    information: Array
    deviance: float
    slope: float
    slope_variance: float
    slope_degrees: float

    @property
    def covariance(self) -> Array:
        """Of the variances, (4, 4), zero where absent."""
        result = np.zeros((4, 4))
        if self.inside:
            scale = 1 / np.sqrt(np.diag(self.information))
            inverse = np.linalg.pinv(self.information * np.outer(scale, scale), hermitian=True)
            result[np.ix_(self.inside, self.inside)] = inverse * np.outer(scale, scale)
        return result


@dataclass(frozen=True, eq=False)
class _At:
    """Deviance at some variances, its gradient (4,), half its expected second derivative (4, 4)."""

    deviance: float
    gradient: Array
    information: Array
    slope: float = 0.0
    slope_variance: float = 0.0
    slope_gradient: Array | None = None


@dataclass(frozen=True, eq=False)
class Likelihood:
    """Of one channel.

    density, degrees: (b,), and shapes: (4, b), of the bins; products: one (k, k), sums: one (k,)
    for each of `lowest`. All in units in which they are of order 1.
    """

    density: Array
    degrees: Array
    shapes: Array
    lowest: tuple[Lowest, ...]
    products: tuple[Array, ...]
    sums: tuple[Array, ...]
    unit: float

    @classmethod
    def of(cls, bins: Bins, lowest: Iterable[Lowest], channel: int, used: Booleans) -> "Likelihood":
        """The likelihood of a channel by the bins that are used, (b,)."""
        groups = tuple(lowest)
        density = bins.density[used, channel]
        unit = float(np.median(density)) or 1.0
        return cls(
            density / unit,
            bins.degrees[used],
            bins.shapes[:, used],
            groups,
            tuple(group.products[channel] / unit for group in groups),
            tuple(group.sums[channel] / np.sqrt(unit) for group in groups),
            unit,
        )

    def maximum(
        self,
        free: Sequence[int],
        ramp: bool,
        *,
        restricted: bool = True,
        held: tuple[int, float] | None = None,
        start: Array | None = None,
    ) -> Fit:
        """The maximum over the free variances, all ≥ 0; `held`: one of them, at a value, U²…."""
        inside = [j for j in free if held is None or j != held[0]]
        theta = np.zeros(4)
        if start is not None:
            theta[inside] = start[inside] / self.unit
        if held is not None:
            theta[held[0]] = held[1] / self.unit
        if inside and (start is None or not theta.any()):
            theta[inside] = self._first(inside, theta)
        at = self._at(theta, ramp, restricted)
        for _ in range(MAX_STEPS):
            if not inside:
                break
            aim = theta.copy()
            aim[inside] = _step(theta, at, inside)
            change = aim - theta
            if abs(at.gradient @ change) < TOLERANCE:
                break  # the deviance would fall by less
            for halving in range(MAX_HALVINGS):
                trial = theta + change * 0.5**halving
                then = self._at(trial, ramp, restricted)
                if then.deviance <= at.deviance:
                    break
            else:
                break
            gained = at.deviance - then.deviance
            theta, at = trial, then
            if gained < TOLERANCE and halving == 0:
                break
        return self._fit(theta, at, free)

    def end_of_interval(
        self, fit: Fit, free: Sequence[int], ramp: bool, j: int, rise: float, up: bool
    ) -> float:
        """Where the deviance, the other variances fitted anew, has risen by so much; 0 if nowhere.

        In the variance of term j, below or above its estimate.
        """
        covariance, best = fit.covariance, fit.variances[j]
        if covariance[j, j] > 0:
            sigma, slopes = float(np.sqrt(covariance[j, j])), covariance[j] / covariance[j, j]
        else:
            sigma, slopes = self._sigma_at_zero(fit, ramp, j), np.zeros(4)

        # The root of the rise is almost a straight line of the coefficient.
        def excess(coefficient: float) -> float:
            near = np.maximum(fit.variances + slopes * (coefficient**2 - best), 0.0)
            there = self.maximum(free, ramp, held=(j, coefficient**2), start=near)
            return float(np.sqrt(max(there.deviance - fit.deviance, 0.0)) - np.sqrt(rise))

        sign = 1 if up else -1
        if not up and best < FAR * sigma and excess(0.0) <= 0:
            return 0.0
        inner, below = float(np.sqrt(best)), -float(np.sqrt(rise))
        wanted = best + sign * np.sqrt(rise) * sigma
        x = float(np.sqrt(wanted)) if wanted > 0 else inner / 2
        outer: float | None = None if up else 0.0
        other, value = inner, below
        for _ in range(MAX_STEPS):
            now = excess(x)
            if abs(now) < END_TOLERANCE:
                break
            if now < 0:
                inner = x
            else:
                outer = x
            following = x - now * (x - other) / (now - value) if now != value else np.nan
            other, value = x, now
            if outer is None:
                x = min(max(following, 1.1 * x), 3 * x) if np.isfinite(following) else 2 * x
            elif (following - inner) * (following - outer) < 0:
                x = following
            else:
                x = (inner + outer) / 2
        return x**2

    def _sigma_at_zero(self, fit: Fit, ramp: bool, j: int) -> float:
        information = self._at(fit.variances / self.unit, ramp, True).information[j, j]
        return float(self.unit / np.sqrt(information))

    def _first(self, free: Sequence[int], theta: Array) -> Array:
        """A first guess by relative least squares of the densities."""
        if not len(self.density):
            scale = np.array([np.trace(group.shapes[j]) for group in self.lowest for j in free])
            total = sum(map(np.trace, self.products)) / sum(group.count for group in self.lowest)
            return np.asarray(total / scale[: len(free)] / len(free))
        weights = np.sqrt(self.degrees) / np.maximum(self.density, 1e-12 * self.density.max())
        design = (self.shapes[free] * weights).T
        scale = np.linalg.norm(design, axis=0)
        found = nnls(design / scale, weights * (self.density - theta @ self.shapes))[0] / scale
        if not found.any() and not theta.any():
            found = np.median(self.density) / np.median(self.shapes[free], axis=1) / len(free)
        return np.asarray(found)

    def _at(self, theta: Array, ramp: bool, restricted: bool) -> _At:
        expected = theta @ self.shapes
        if not expected.all() or not theta.any():
            return _At(np.inf, np.zeros(4), np.eye(4))
        relative = self.shapes / expected
        ratio = self.density / expected
        deviance = float(self.degrees @ (np.log(expected) + ratio))
        gradient = relative @ (self.degrees * (1 - ratio))
        information = (relative * self.degrees) @ relative.T / 2
        # Of the ramp: weight w, right side u, and their derivatives.
        w, u = 0.0, 0.0
        dw, du, d2w = np.zeros(4), np.zeros(4), np.zeros((4, 4))
        for shapes, count, ramps, products, sums in self._stacked:
            covariance = np.einsum("j,gjkl->gkl", theta, shapes)
            signs, logs = np.linalg.slogdet(covariance)
            if (signs <= 0).any():
                return _At(np.inf, np.zeros(4), np.eye(4))
            inverse = np.linalg.inv(covariance)
            solved = inverse[:, None] @ shapes
            inverse_products = inverse @ products
            deviance += float(count @ logs + np.trace(inverse_products, axis1=1, axis2=2).sum())
            gradient = gradient + count @ np.trace(solved, axis1=2, axis2=3)
            gradient -= np.einsum("gjkl,glk->j", solved, inverse_products)
            flat = (len(solved), 4, -1)
            across = solved.reshape(flat) @ solved.transpose(0, 1, 3, 2).reshape(flat).mT
            information = information + np.einsum("g,gij->ij", count / 2, across)
            if ramp:
                weighted = np.einsum("gkl,gl->gk", inverse, ramps)
                w += float(count @ np.sum(ramps * weighted, axis=1))
                u += float(np.sum(sums * weighted))
                passed = np.einsum("gjkl,gl->gjk", shapes, weighted)  # C_j W r
                back = passed @ inverse
                dw -= count @ np.einsum("gjk,gk->gj", passed, weighted)
                du -= np.einsum("gjk,gk->j", back, sums)
                d2w += np.einsum("g,gik,gjk->ij", count, passed, back)
        if not ramp:
            return _At(deviance, gradient, information)
        deviance -= u**2 / w
        gradient = gradient - 2 * u * du / w + u**2 * dw / w**2
        if restricted:
            deviance += float(np.log(w))
            gradient = gradient + dw / w
            information = information - d2w / w + np.outer(dw, dw) / w**2 / 2
        return _At(deviance, gradient, information, u / w, 1 / w, -dw / w**2)

    @cached_property
    def _stacked(self) -> list[tuple[Array, Array, Array, Array, Array]]:
        """Of stretches with as many coefficients: shapes, counts, ramps, products, and sums."""
        sizes = sorted({len(group.ramp) for group in self.lowest})
        stacks = []
        for size in sizes:
            own = [i for i, group in enumerate(self.lowest) if len(group.ramp) == size]
            stacks.append(
                (
                    np.stack([self.lowest[i].shapes for i in own]),
                    np.array([float(self.lowest[i].count) for i in own]),
                    np.stack([self.lowest[i].ramp for i in own]),
                    np.stack([self.products[i] for i in own]),
                    np.stack([self.sums[i] for i in own]),
                )
            )
        return stacks

    def _fit(self, theta: Array, at: _At, free: Sequence[int]) -> Fit:
        inside = tuple(j for j in free if theta[j] > 0)
        information = at.information[np.ix_(inside, inside)] / self.unit**2
        degrees = np.inf
        fit = Fit(
            theta * self.unit,
            inside,
            information,
            at.deviance,
            at.slope * np.sqrt(self.unit),
            at.slope_variance * self.unit,
            np.inf,
        )
        if at.slope_gradient is not None:
            # Satterthwaite: the variance of the slope is itself estimated.
            scatter = float(at.slope_gradient @ fit.covariance @ at.slope_gradient)
            degrees = 2 * fit.slope_variance**2 / max(scatter, 1e-300)
        return replace(fit, slope_degrees=degrees)


def _step(theta: Array, at: _At, inside: Sequence[int]) -> Array:
    """The step of Fisher's scoring, by least squares under the constraint that none is negative."""
    information = at.information[np.ix_(inside, inside)]
    scale = 1 / np.sqrt(np.diag(information))
    scaled = information * np.outer(scale, scale)
    right = scaled @ (theta[inside] / scale) - scale * at.gradient[inside] / 2
    lower = np.linalg.cholesky(scaled + 1e-10 * np.eye(len(inside)))
    target = np.linalg.solve(lower, right)
    free = np.linalg.solve(lower.T, target)
    return np.asarray((free if (free >= 0).all() else nnls(lower.T, target)[0]) * scale)
