"""Weighted least squares with prior information: linear, iterated, and by pseudo-inverse.

    observed = design · x + noise,   noise ~ N(0, sigma²),   x ~ N(prior, prior_sigma²)

A parameter has a vague prior. An error that cannot be avoided (the tilt of a position, the angle of
a rate segment) is an unknown too, with its known sigma as prior: equivalent to a covariance of the
observations that contains these errors.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import solve_triangular

from inertial.arrays import Array, Booleans
from inertial.estimation.effect_information import (
    MIN_SPANNED_SHARE,
    EffectInformation,
    NormalEquations,
)
from inertial.estimation.elimination import Eliminated
from inertial.estimation.probability import chi2_sf, f_sf

MIN_SIGMA_REDUCTION = 4.0  # prior sigma over posterior sigma of a determined parameter

# Iterated least squares
MIN_RELATIVE_DECREASE = 1e-8  # of the sum of squares per iteration
MAX_ITERATIONS = 100

MIN_SINGULAR_VALUE = 1e-3  # of the largest; a weaker combination amplifies its errors 1000-fold


@dataclass(frozen=True)
class Estimate:
    """Result of a least-squares fit.

    `values`: (p,); `determined`: (p,); `covariance`: (s, s), of the first s, p unless errors were
    eliminated, with `eliminated_sigma`: (p − s,), of these; `chi_squared` of `degrees` of freedom;
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
    eliminated_sigma: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def sigma(self) -> Array:
        """Standard deviations of the values, (p,)."""
        return np.append(np.sqrt(np.diag(self.covariance)), self.eliminated_sigma)

    def p_value(self, noise_degrees: float = np.inf) -> float:
        """Probability of a larger sum of squares if the model is right.

        `noise_degrees`: of freedom of the noise variance where that is estimated too, so that the
        sum of squares per degree follows the F distribution.
        """
        if not self.degrees:
            return 1.0
        if np.isinf(noise_degrees):
            return float(chi2_sf(self.chi_squared, self.degrees))
        ratio = self.chi_squared / self.degrees
        return float(f_sf(ratio, self.degrees, noise_degrees))


def solve(
    design: Array,
    observed: Array,
    sigma: Array,
    prior: Array,
    prior_sigma: Array,
    parameters: int,
    count: int | None = None,
) -> Estimate:
    """The estimate of smallest variance, by orthogonal triangularisation.

    Parameters
    ----------
    design : (n, p)
    observed, sigma : (n,)
    prior, prior_sigma : (p,)
    parameters : number of unknowns with vague priors, the first ones; the others are errors, each
        of which is an observation of zero as well
    count : of the observations, where they were compressed into fewer rows before
    """
    n, p = design.shape
    # In units of the priors every column is of comparable size.
    scaled = design / sigma[:, None] * prior_sigma
    residual = (observed - design @ prior) / sigma
    stacked = np.vstack([np.column_stack([scaled, residual]), np.eye(p, p + 1)])
    triangle: Array = np.linalg.qr(stacked, mode="r")  # type: ignore[assignment]
    upper, right = triangle[:p, :p], triangle[:p, p]
    inverse = solve_triangular(upper, np.eye(p))
    covariance = inverse @ inverse.T
    change = inverse @ right
    shrunk = np.diag(covariance)
    chi_squared = float(np.sum((residual - scaled @ change) ** 2) + np.sum(change**2))
    return Estimate(
        values=prior + prior_sigma * change,
        covariance=covariance * np.outer(prior_sigma, prior_sigma),
        determined=shrunk < MIN_SIGMA_REDUCTION**-2,
        chi_squared=chi_squared,
        # A parameter that stays at its prior takes no degree of freedom.
        degrees=max(round((count or n) - float(np.sum(1 - shrunk[:parameters]))), 0),
        deviance=chi_squared
        + 2 * float(np.sum(np.log(sigma)))
        + 2 * float(np.sum(np.log(np.abs(np.diag(upper))))),
        rows=count or n,
    )


@dataclass(frozen=True)
class System:
    """Equations with the names of their unknowns.

    `names`: (p,), kind and name of each unknown; kinds are parameter, effect, and those of
    the errors. `parameters`: as in `solve`. `eliminated`: errors that were eliminated from these
    equations; the estimate has them behind the others.
    """

    design: Array
    observed: Array
    sigma: Array
    prior: Array
    prior_sigma: Array
    parameters: int
    names: tuple[tuple[str, str], ...]
    eliminated: Eliminated | None = None

    @property
    def rows(self) -> int:
        """The number of observations."""
        return len(self.observed) if self.eliminated is None else self.eliminated.count

    def solve(self) -> Estimate:
        """The estimate of smallest variance."""
        shared = self.solve_shared()
        if self.eliminated is None:
            return shared
        values, sigma = self.eliminated.estimate(shared.values - self.prior, shared.covariance)
        names = self.eliminated.names
        known = np.array([self.eliminated.sigma.get(name, np.inf) for name in names])
        return replace(
            shared,
            names=(*self.names, *names),
            values=np.append(shared.values, values),
            eliminated_sigma=sigma,
            determined=np.append(shared.determined, sigma < known / MIN_SIGMA_REDUCTION),
        )

    def solve_shared(self) -> Estimate:
        """The same without the eliminated errors."""
        rows = (self.design, self.observed, self.sigma)
        estimate = solve(*rows, self.prior, self.prior_sigma, self.parameters, self.rows)
        of_errors = self.eliminated.deviance if self.eliminated else 0.0
        return replace(estimate, names=self.names, deviance=estimate.deviance + of_errors)

    def column(self, kind: str, name: str) -> int | None:
        """The place of an unknown in the estimate."""
        names = (*self.names, *(self.eliminated.names if self.eliminated else ()))
        return names.index((kind, name)) if (kind, name) in names else None

    @property
    def _effects(self) -> list[int]:
        return [i for i, (kind, _) in enumerate(self.names) if kind == "effect"]

    def _all_but(self, places: Sequence[int]) -> list[int]:
        """The places of the other unknowns."""
        left_out = set(places)
        return [i for i in range(len(self.names)) if i not in left_out]

    def _whitened(self) -> tuple[Array, Array]:
        """Design and residuals about the prior in units of sigma."""
        residual = (self.observed - self.design @ self.prior) / self.sigma
        return self.design / self.sigma[:, None], residual

    def raw_information(self) -> Array:
        """The information of the column of each effect, nothing else fitted, (k,)."""
        return np.asarray(np.sum(self._whitened()[0][:, self._effects] ** 2, axis=0))

    def projected(self, fitted: int) -> tuple[Array, Array, Array]:
        """Residuals and columns of effects, orthogonal to all that is fitted.

        `fitted`: number of effects that are fitted as well, the first ones. The prior of an
        unknown is an observation.

        Returns
        -------
        the residuals (n + p,) and the further columns (n + p, k), both in units of sigma, and the
        squared norms of the columns before projection (k,)
        """
        further = self._effects[fitted:]
        base = self._all_but(further)
        scaled, residual = self._whitened()
        stacked = np.vstack([scaled[:, base] * self.prior_sigma[base], np.eye(len(base))])
        columns = np.vstack([scaled[:, further], np.zeros((len(base), len(further)))])
        space = np.linalg.qr(stacked)[0]
        values = np.append(residual, np.zeros(len(base)))
        return (
            values - space @ (space.T @ values),
            columns - space @ (space.T @ columns),
            np.sum(columns**2, axis=0),
        )

    def shifts(self, fitted: int) -> tuple[list[str], Array]:
        """What effects of the size one move, if the readings have them and the fit does not.

        `fitted`: as in `projected`. The names of the m determined parameters, and (m, k), of the
        further effects, in sigmas of the parameters.
        """
        further = self._effects[fitted:]
        base = self._all_but(further)
        scaled, _ = self._whitened()
        design = np.vstack([scaled[:, base] * self.prior_sigma[base], np.eye(len(base))])
        inverse = solve_triangular(np.linalg.qr(design, mode="r"), np.eye(len(base)))
        covariance = inverse @ inverse.T  # in units of the priors, as the changes
        changes = covariance @ (design[: len(scaled)].T @ scaled[:, further])
        sigma = np.sqrt(np.diag(covariance))
        own = [
            i
            for i, at in enumerate(base)
            if self.names[at][0] == "parameter" and sigma[i] < 1 / MIN_SIGMA_REDUCTION
        ]
        return [self.names[base[i]][1] for i in own], changes[own] / sigma[own, None]

    def effect_information(self) -> EffectInformation:
        """The normal equations of the effects, all other unknowns fitted."""
        equations = NormalEquations(self.names, self.prior_sigma)
        equations.add(np.column_stack(self._whitened()))
        return equations.information(self.rows, self.parameters).on_effects


def remaining(
    rows: Array,
    eliminated: Eliminated,
    prior: Array,
    prior_sigma: Array,
    parameters: int,
    names: tuple[tuple[str, str], ...],
) -> System:
    """The system of the rows that `eliminate` leaves, (m, s + 1), about the priors."""
    design = rows[:, :-1]
    observed, unit = rows[:, -1] + design @ prior, np.ones(len(rows))
    return System(design, observed, unit, prior, prior_sigma, parameters, names, eliminated)


# Equations from which errors were eliminated, and the order of all unknowns before that.
Stepped = tuple[System, tuple[tuple[str, str], ...]]
MIN_SHARE_OF_STEP = 1e-3  # a step that must be shorter for the sum of squares to fall is none


def solve_stepped(
    linearised: Callable[[Array], Stepped], squares: Callable[[Array], float], start: Array
) -> Estimate:
    """The estimate of smallest variance where the design depends on the unknowns.

    The equations are linearised about each last result until the weighted sum of squares is
    smallest; errors may be eliminated from them. Each step goes to the estimate of the linear
    equations, or as far towards it as the sum of squares falls (Gauss & Newton, halved steps).

    Parameters
    ----------
    linearised : the equations about given unknowns (p,), where their residuals are exact
    squares : the sum of squares at given unknowns, of their priors too
    start : (p,), initial values
    """
    values, least = start, squares(start)
    for _unused in range(MAX_ITERATIONS):
        system, order = linearised(values)
        estimate = system.solve()
        step = in_order(estimate, order) - values
        share, before = 1.0, least
        while (found := squares(values + share * step)) >= before and share > MIN_SHARE_OF_STEP:
            share /= 2
        if not found < before:
            return estimate
        values, least = values + share * step, found
        if before - least < MIN_RELATIVE_DECREASE * before:
            break
    return linearised(values)[0].solve()


def in_order(estimate: Estimate, names: Sequence[tuple[str, str]]) -> Array:
    """The values of these unknowns."""
    place = {name: i for i, name in enumerate(estimate.names)}
    return np.asarray(estimate.values[[place[name] for name in names]])


def with_errors_in_order(estimate: Estimate, names: Sequence[tuple[str, str]]) -> Estimate:
    """The same with the errors that were eliminated in the order of these names."""
    shared = len(estimate.covariance)
    place = {name: i for i, name in enumerate(names)}
    order = sorted(range(shared, len(estimate.names)), key=lambda i: place[estimate.names[i]])
    whole = [*range(shared), *order]
    return replace(
        estimate,
        names=tuple(estimate.names[i] for i in whole),
        values=estimate.values[whole],
        determined=estimate.determined[whole],
        eliminated_sigma=estimate.sigma[order],
    )


def counted(estimate: Estimate, vague: Mapping[tuple[str, str], float]) -> Estimate:
    """With the degrees of freedom that unknowns leave of which nothing is known beforehand.

    vague : the sigma of the prior of each, whether it was eliminated or not
    """
    sigma = dict(zip(estimate.names, estimate.sigma.tolist(), strict=True))
    taken = sum(1 - (sigma[name] / prior) ** 2 for name, prior in vague.items())
    return replace(estimate, degrees=max(round(estimate.rows - taken), 0))


def with_columns(system: System, shown: frozenset[str]) -> System:
    """The equations with these columns of effects only."""
    kept = [i for i, (kind, name) in enumerate(system.names) if kind != "effect" or name in shown]
    return replace(
        system,
        design=system.design[:, kept],
        prior=system.prior[kept],
        prior_sigma=system.prior_sigma[kept],
        names=tuple(system.names[i] for i in kept),
        # The eliminated errors are not used here, and refer to the other columns.
        eliminated=system.eliminated and replace(system.eliminated, steps=()),
    )


@dataclass(frozen=True)
class PseudoInverse:
    """The pseudo-inverse of a design, its rank, and the columns that it determines.

    `inverse`: (q, n), so that unknowns = inverse · observations; `determined`: (q,).
    """

    inverse: Array
    rank: int
    determined: Booleans


def pseudo_inverse(design: Array) -> PseudoInverse:
    """For least squares as the sources print it, [M | b] = L Aᵀ (A Aᵀ)⁻¹, A of any rank.

    A Aᵀ can be inverted only where the inputs span all rows of A. S4 turned each gyro about its own
    axis alone, so its inputs have rank 2 of 4; it permuted them until the matrix could be inverted,
    and printed cross terms without any information. Here only the part that the inputs span is
    inverted, and a column outside of it is not determined.

    `design`: (n, q), n observations and q unknowns; columns are scaled to length 1, so their units
    do not matter.
    """
    length = np.linalg.norm(design, axis=0)
    unit = np.where(length > 0, length, 1.0)
    left, values, right = np.linalg.svd(design / unit, full_matrices=False)
    used = values > MIN_SINGULAR_VALUE * values.max(initial=0.0)
    inverse = (right[used].T / values[used]) @ left[:, used].T / unit[:, None]
    outside = 1 - np.sum(right[used] ** 2, axis=0)
    return PseudoInverse(inverse, int(used.sum()), np.asarray(outside < 1 - MIN_SPANNED_SHARE))
