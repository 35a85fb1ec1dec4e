"""Weighted least squares with prior knowledge: linear, iterated, and by pseudo-inverse."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.optimize import least_squares, minimize_scalar

from inertial.estimation.elimination import Apart, led
from inertial.estimation.probability import chi_squared_beyond, ratio_beyond

# ---- Weighted least squares with what is known beforehand, and what the data then tell.
#
#     observed = design · x + noise,   noise ~ N(0, sigma²),   x ~ N(prior, prior_sigma²)
#
# A parameter that is sought has a prior so vague that it tells nothing; an error that
# cannot be avoided (the tilt of a position, the angle of a turn) is an unknown of
# its own whose prior is its known sigma. That is the same as a covariance of the
# observations that contains these errors.

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]

MIN_INFORMATION_SHARE = 1e-8  # of the information of a column on its own: what is less is rounding
NARROWED = 4.0  # a parameter is determined when the data narrow its vague prior so many times


@dataclass(frozen=True)
class Estimate:
    """What least squares gives.

    `values`: (p,); `determined`: (p,); `covariance`: (s, s), of the first s, p unless errors were
    eliminated, with `sigma_apart`: (p − s,), of these; `chi_squared` of `degrees` of freedom;
    `deviance`: −2 log of the restricted likelihood, up to a constant.
    """

    values: Array
    covariance: Array
    determined: Booleans
    chi_squared: float
    degrees: int
    deviance: float
    rows: int
    names: tuple[tuple[str, str], ...] = ()  # kind and name of each unknown, see System
    sigma_apart: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def sigma(self) -> Array:
        """Standard deviations of the values, (p,)."""
        return np.append(np.sqrt(np.diag(self.covariance)), self.sigma_apart)

    def p_value(self, noise_degrees: float = np.inf) -> float:
        """Chance of a larger sum of squares if the model is right.

        The noise is estimated too: a variance from so many degrees of freedom, so that
        the sum of squares per degree follows the F distribution.
        """
        if not self.degrees:
            return 1.0
        if np.isinf(noise_degrees):
            return float(chi_squared_beyond(self.chi_squared, self.degrees))
        ratio = self.chi_squared / self.degrees
        return float(ratio_beyond(ratio, self.degrees, noise_degrees))


def solve(
    design: Array,
    observed: Array,
    sigma: Array,
    prior: Array,
    prior_sigma: Array,
    sought: int,
    count: int | None = None,
) -> Estimate:
    """The estimate of smallest variance, by orthogonal triangularisation.

    Parameters
    ----------
    design : (n, p)
    observed, sigma : (n,)
    prior, prior_sigma : (p,)
    sought : the first so many unknowns are parameters with vague priors; the others
        are errors, each of which is an observation of zero as well
    count : of the observations, where they were made fewer rows before
    """
    n, p = design.shape
    # In units of the priors every column is of comparable size.
    scaled = design / sigma[:, None] * prior_sigma
    rest = (observed - design @ prior) / sigma
    stacked = np.vstack([np.column_stack([scaled, rest]), np.eye(p, p + 1)])
    triangle: Array = np.linalg.qr(stacked, mode="r")  # type: ignore[assignment]
    upper, right = triangle[:p, :p], triangle[:p, p]
    inverse = solve_triangular(upper, np.eye(p))
    covariance = inverse @ inverse.T
    moved = inverse @ right
    shrunk = np.diag(covariance)
    remaining = float(np.sum((rest - scaled @ moved) ** 2) + np.sum(moved**2))
    return Estimate(
        values=prior + prior_sigma * moved,
        covariance=covariance * np.outer(prior_sigma, prior_sigma),
        determined=shrunk < NARROWED**-2,
        chi_squared=remaining,
        # A parameter that the data leave where it was takes no degree of freedom.
        degrees=max(round((count or n) - float(np.sum(1 - shrunk[:sought]))), 0),
        deviance=remaining
        + 2 * float(np.sum(np.log(sigma)))
        + 2 * float(np.sum(np.log(np.abs(np.diag(upper))))),
        rows=count or n,
    )


@dataclass(frozen=True)
class System:
    """Equations, and the names of their unknowns: the arguments of `solve` as one thing.

    `names`: (p,), kind and name of each unknown; kinds are parameter, effect, and those of
    the errors. `apart`: errors that were eliminated from these equations; the estimate has
    them behind the others.
    """

    design: Array
    observed: Array
    sigma: Array
    prior: Array
    prior_sigma: Array
    sought: int
    names: tuple[tuple[str, str], ...]
    apart: Apart | None = None

    @property
    def rows(self) -> int:
        """The number of observations."""
        return len(self.observed) if self.apart is None else self.apart.count

    def solve(self) -> Estimate:
        """The estimate of smallest variance."""
        shared = self.solve_shared()
        if self.apart is None:
            return shared
        moved = shared.values - self.prior
        values, sigma = self.apart.found(moved, shared.covariance)
        names = self.apart.names
        known = np.array([self.apart.sigma.get(name, np.inf) for name in names])
        return replace(
            shared,
            names=(*self.names, *names),
            values=np.append(shared.values, values),
            sigma_apart=sigma,
            determined=np.append(shared.determined, sigma < known / NARROWED),
        )

    def solve_shared(self) -> Estimate:
        """The same without the errors that were eliminated."""
        rows = (self.design, self.observed, self.sigma)
        estimate = solve(*rows, self.prior, self.prior_sigma, self.sought, self.rows)
        of_errors = self.apart.deviance if self.apart else 0.0
        return replace(estimate, names=self.names, deviance=estimate.deviance + of_errors)

    def column(self, kind: str, name: str) -> int | None:
        """Where an unknown stands in the estimate."""
        names = (*self.names, *(self.apart.names if self.apart else ()))
        return names.index((kind, name)) if (kind, name) in names else None

    def raw_information(self) -> Array:
        """The information of the column of each effect, nothing else fitted, (k,)."""
        effects = [i for i, (kind, _) in enumerate(self.names) if kind == "effect"]
        return np.asarray(np.sum((self.design[:, effects] / self.sigma[:, None]) ** 2, axis=0))

    def left(self, fitted: int) -> tuple[Array, Array, Array]:
        """What is left when all is fitted but the effects after the first so many columns.

        What is known beforehand of an unknown is a reading of its own.

        Returns
        -------
        the residuals (n + p,) and the further columns (n + p, k), both in units of sigma, and the
        columns' own squares (k,)
        """
        effects = [i for i, (kind, _) in enumerate(self.names) if kind == "effect"]
        asked = effects[fitted:]
        base = [i for i in range(len(self.names)) if i not in set(asked)]
        scaled = self.design / self.sigma[:, None]
        rest = (self.observed - self.design @ self.prior) / self.sigma
        stacked = np.vstack([scaled[:, base] * self.prior_sigma[base], np.eye(len(base))])
        columns = np.vstack([scaled[:, asked], np.zeros((len(base), len(asked)))])
        space = np.linalg.qr(stacked)[0]
        values = np.append(rest, np.zeros(len(base)))
        return (
            values - space @ (space.T @ values),
            columns - space @ (space.T @ columns),
            np.sum(columns**2, axis=0),
        )

    def reduced(self) -> "Reduced":
        """What the data say of the effects, all other unknowns fitted."""
        effects = [i for i, (kind, _) in enumerate(self.names) if kind == "effect"]
        others = [i for i, (kind, _) in enumerate(self.names) if kind != "effect"]
        scaled = self.design / self.sigma[:, None]
        rest = (self.observed - self.design @ self.prior) / self.sigma
        base = scaled[:, others] * self.prior_sigma[others]
        stacked = np.zeros((len(rest) + len(others), len(others) + len(effects) + 1))
        stacked[: len(rest)] = np.column_stack([base, scaled[:, effects], rest])
        stacked[len(rest) :, : len(others)] = np.eye(len(others))
        corner = led(stacked, len(others))[len(others) :, len(others) :]
        columns, right = corner[:, :-1], corner[:, -1]
        return Reduced(
            tuple(self.names[i][1] for i in effects),
            columns.T @ columns,
            columns.T @ right,
            float(right @ right),
            self.rows - self.sought,
        )


@dataclass(frozen=True)
class Reduced:
    """What equations say of the effects alone, in the form β ~ (F⁻¹ b, F⁻¹).

    `names`: (k,); `information`: F, (k, k); `right`: b, (k,); `chi_squared` on `degrees`: what
    is left without the effects. Independent equations add up.
    """

    names: tuple[str, ...]
    information: Array
    right: Array
    chi_squared: float
    degrees: int

    def __add__(self, other: "Reduced") -> "Reduced":
        if self.names != other.names:
            raise ValueError("the equations are not about the same effects")
        return Reduced(
            self.names,
            self.information + other.information,
            self.right + other.right,
            self.chi_squared + other.chi_squared,
            self.degrees + other.degrees,
        )

    def of(self, names: Sequence[str]) -> "Reduced":
        """The same of some of the effects, the others being none."""
        place = {name: i for i, name in enumerate(self.names)}
        some = [place[name] for name in names]
        information = self.information[np.ix_(some, some)]
        return replace(self, names=tuple(names), information=information, right=self.right[some])

    def drop(self, chosen: Sequence[int]) -> tuple[float, int]:
        """By how much chi-squared drops with the chosen columns, and on how many degrees."""
        values, directions, _ = self._modes(chosen)
        along = directions.T @ self.right[list(chosen)]
        return float(np.sum(along**2 / values)), len(values)

    def estimate(self, chosen: Sequence[int]) -> tuple[Array, Array]:
        """Values and covariance of the chosen columns; NaN where the data do not show one."""
        values, directions, blind = self._modes(chosen)
        covariance = (directions / values) @ directions.T
        beta = covariance @ self.right[list(chosen)]
        hidden = blind[:, None] | blind[None, :]
        return np.where(blind, np.nan, beta), np.where(hidden, np.nan, covariance)

    def _modes(self, chosen: Sequence[int]) -> tuple[Array, Array, Booleans]:
        """The combinations of the chosen columns that the data show.

        Returns
        -------
        their information (m,), the combinations (k, m), and which columns they do not span (k,)
        """
        block = self.information[np.ix_(chosen, chosen)]
        size = np.sqrt(np.maximum(np.diag(block), np.finfo(float).tiny))
        values, vectors = np.linalg.eigh(block / np.outer(size, size))
        seen = values > MIN_INFORMATION_SHARE
        spanned = np.sum(vectors[:, seen] ** 2, axis=1)
        return values[seen], vectors[:, seen] / size[:, None], spanned < 1 - 1e-6


LIKELIER = 6.6  # drop of the deviance that a scatter must bring: 1 % of chi-squared of 1 degree
STEP = 4.0  # ratio of one scatter to the next, where the likeliest is looked for
WORSE = 20.0  # of the deviance, above the least so far: where the search ends
INCONSISTENT = 0.01  # p-value below which the residuals are larger than the noise


@dataclass(frozen=True)
class Fitted:
    """A fit, what it allows for, and the p-value of the fit that allows for noise alone.

    `scatter`, in the unit of the readings; `walk`: random walk of the bias, per √s, and its sigma.
    """

    estimate: Estimate
    scatter: float
    p_value: float
    walk: float = 0.0
    walk_sigma: float = 0.0


def _scatter(deviance: Callable[[float], float], between: tuple[float, float]) -> float:
    """The least scatter than which neither less nor more is likelier.

    There may be another, so large that nothing is left of what the manoeuvres have in common: then
    any parameters would do.
    """
    low, high = np.log(between)
    sizes = np.linspace(low, high, int(np.ceil((high - low) / np.log(STEP))) + 1)
    found: list[float] = []
    for size in sizes:
        found.append(deviance(float(np.exp(size))))
        if found[-1] > min(found) + WORSE:
            break
    best = int(np.argmin(found))
    near = minimize_scalar(
        lambda logarithm: deviance(float(np.exp(logarithm))),
        bounds=(sizes[max(best - 1, 0)], sizes[min(best + 1, len(sizes) - 1)]),
        method="bounded",
        options={"xatol": 0.05},
    )
    return float(np.exp(near.x))


def with_scatter(
    fit: Callable[[float], Estimate], between: tuple[float, float], noise_degrees: float
) -> Fitted:
    """Fit again with a scatter between manoeuvres where noise alone cannot explain the residuals.

    What the model lacks makes every manoeuvre differ from the others by more than the
    noise, and sigmas of noise alone would promise too much. So the readings of each
    manoeuvre get an offset of their own, N(0, scatter²), whose size is the one of largest
    restricted likelihood (Patterson & Thompson 1971).

    Parameters
    ----------
    fit : the estimate as a function of the scatter
    between : smallest and largest scatter, in the unit of the readings
    noise_degrees : see `Estimate.p_value`
    """
    alone = fit(0.0)
    p_value = alone.p_value(noise_degrees)
    if p_value >= INCONSISTENT:
        return Fitted(alone, 0.0, p_value)
    scatter = _scatter(lambda size: fit(size).deviance, between)
    scattered = fit(scatter)
    if alone.deviance - scattered.deviance < LIKELIER:
        return Fitted(alone, 0.0, p_value)
    return Fitted(scattered, scatter, p_value)


# ---- Equations that are not linear in their unknowns: least squares until nothing moves any more.
#
# The equations are made anew about each last result, as rows that are linear there, until the
# weighted sum of squares is the smallest (Levenberg & Marquardt, as MINPACK has it). What is
# returned is the linear estimate about that place, with its covariance.

NONE = 1e-8  # relative change of the sum of squares that is none
TINY = 1e-15  # so that no small step of one unknown among large ones counts as the end
MOST = 100  # times that the equations are made


def settled(about: Callable[[Array], System], start: Array) -> Estimate:
    """The estimate of smallest variance where the design depends on the unknowns.

    Parameters
    ----------
    about : the equations, linear about given unknowns (p,); there their residuals are exact
    start : (p,), where to begin
    """
    first = about(start)
    prior, width = first.prior, first.prior_sigma

    @lru_cache(maxsize=1)
    def at(moved: bytes) -> System:
        return about(prior + width * np.frombuffer(moved))

    def residual(moved: Array) -> Array:
        system = at(moved.tobytes())
        away = system.observed - system.design @ (prior + width * moved)
        return np.append(away / system.sigma, -moved)

    def slope(moved: Array) -> Array:
        system = at(moved.tobytes())
        return -np.vstack([system.design / system.sigma[:, None] * width, np.eye(len(moved))])

    begin = (start - prior) / width
    found = least_squares(
        residual,
        begin,
        slope,
        method="lm",
        x_scale="jac",
        ftol=NONE,
        xtol=TINY,
        gtol=TINY,
        max_nfev=MOST,
    )
    return about(np.asarray(prior + width * found.x)).solve()


# ---- Least squares as the sources print it, [M | b] = L Aᵀ (A Aᵀ)⁻¹, where A may not be spanned.
#
# A Aᵀ can be inverted only where the inputs span all rows of A. S4 turned each gyro about its own
# axis alone, so what was used of its inputs has rank 2 of 4; it permuted them until the matrix
# could be inverted, and found cross terms that no data had shown. Here the inverse is that of the
# part that is spanned, and what lies outside of it is not determined.

SEEN = 1e-3  # of the strongest combination of inputs; a weaker one would show its errors 1000-fold
OUTSIDE = 1e-6  # share of a column that may lie outside of what is spanned


@dataclass(frozen=True)
class Spanned:
    """The inverse of a design, its rank, and the columns that it determines.

    `inverse`: (q, n), so that unknowns = inverse · observations; `determined`: (q,).
    """

    inverse: Array
    rank: int
    determined: Booleans


def spanned(design: Array) -> Spanned:
    """Invert a design of n observations and q unknowns, (n, q), of any rank.

    The columns count in units of their own length, so their units do not matter.
    """
    length = np.linalg.norm(design, axis=0)
    unit = np.where(length > 0, length, 1.0)
    left, values, right = np.linalg.svd(design / unit, full_matrices=False)
    seen = values > SEEN * values.max(initial=0.0)
    inverse = (right[seen].T / values[seen]) @ left[:, seen].T / unit[:, None]
    outside = 1 - np.sum(right[seen] ** 2, axis=0)
    return Spanned(inverse, int(seen.sum()), np.asarray(outside < OUTSIDE))
