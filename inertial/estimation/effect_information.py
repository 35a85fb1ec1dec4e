"""Normal equations of effects alone, all other unknowns eliminated.

On them rest the statistics of every effect, or set of effects: how much of chi-squared it explains,
its values with their covariance, and the same beside others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import solve_triangular

from inertial.arrays import Array, Booleans
from inertial.estimation.elimination import Name, partial_r_factor

MIN_INFORMATION_SHARE = 1e-8  # of the information of a column on its own: what is less is rounding
MIN_SPANNED_SHARE = 1 - 1e-6  # of a column within the combinations that the data determine
MIN_ROWS_PER_PRODUCT = 1000  # of normal equations: fewer read and write them more often


@dataclass(frozen=True)
class EffectInformation:
    """Normal equations F β = b of the effects alone, so that β ~ (F⁻¹ b, F⁻¹).

    `names`: (k,); `information`: F, (k, k); `right`: b, (k,); `chi_squared` on `degrees` of
    freedom: without the effects. Those of independent equations add up.
    """

    names: tuple[str, ...]
    information: Array
    right: Array
    chi_squared: float
    degrees: int

    def __add__(self, other: "EffectInformation") -> "EffectInformation":
        if self.names != other.names:
            raise ValueError("the equations are not about the same effects")
        return EffectInformation(
            self.names,
            self.information + other.information,
            self.right + other.right,
            self.chi_squared + other.chi_squared,
            self.degrees + other.degrees,
        )

    def of(self, names: Sequence[str]) -> "EffectInformation":
        """The same for some of the effects, the others being zero."""
        place = {name: i for i, name in enumerate(self.names)}
        some = [place[name] for name in names]
        information = self.information[np.ix_(some, some)]
        return replace(self, names=tuple(names), information=information, right=self.right[some])

    def drop(self, chosen: Sequence[int]) -> tuple[float, int]:
        """Decrease of chi-squared by the chosen columns, and its degrees of freedom."""
        values, directions, _ = self._modes(chosen)
        along = directions.T @ self.right[list(chosen)]
        return float(np.sum(along**2 / values)), len(values)

    def given(self, fitted: Sequence[int]) -> "EffectInformation":
        """The same with some columns fitted as well, on which no information remains."""
        own = list(fitted)
        values, directions, _ = self._modes(own)
        white = directions / np.sqrt(values)
        across = self.information[:, own] @ white
        drop, used = self.drop(own)
        information = self.information - across @ across.T
        right = self.right - across @ (white.T @ self.right[own])
        information[own], information[:, own], right[own] = 0.0, 0.0, 0.0
        return replace(
            self,
            information=information,
            right=right,
            chi_squared=self.chi_squared - drop,
            degrees=self.degrees - used,
        )

    def eliminated(self, prior: Array) -> "EffectInformation":
        """The same without the last columns, errors with the information `prior` each, (t,)."""
        k = len(self.names) - len(prior)
        own = self.information[k:, k:] + np.diag(prior)
        across = np.linalg.solve(own, np.column_stack([self.information[k:, :k], self.right[k:]]))
        drop = self.information[:k, k:] @ across
        return replace(
            self,
            names=self.names[:k],
            information=self.information[:k, :k] - drop[:, :-1],
            right=self.right[:k] - drop[:, -1],
            chi_squared=self.chi_squared - float(self.right[k:] @ across[:, -1]),
        )

    def by_others(self, matrix: Array, names: Sequence[str]) -> "EffectInformation":
        """The same with the last columns, errors, as a function of others, (t, u), by name."""
        k = len(self.names) - len(matrix)
        own, across = self.information[:k, :k], self.information[:k, k:] @ matrix
        return replace(
            self,
            names=(*self.names[:k], *names),
            information=np.block(
                [[own, across], [across.T, matrix.T @ self.information[k:, k:] @ matrix]]
            ),
            right=np.append(self.right[:k], matrix.T @ self.right[k:]),
        )

    def deviance_as_errors(self, prior: Array) -> float:
        """−2 log of the likelihood with these as errors less that without; see `eliminated`."""
        with_prior = self.information + np.diag(prior)
        log_det = np.linalg.slogdet(with_prior)[1] - np.sum(np.log(prior))
        return float(log_det - self.right @ np.linalg.solve(with_prior, self.right))

    def following(self, other: "EffectInformation", prior: Array) -> "EffectInformation":
        """What these equations add to those of another sensor that has the same errors.

        The errors δ are the last columns. The others say δ ~ (S⁻¹ b − S⁻¹ F β, S⁻¹) for effects β,
        with S their information on δ and its `prior`, (t,). About that these equations have
        columns and residuals of their own, and what remains of δ is eliminated from them; so the
        information of both adds up as that of independent equations.
        """
        k = len(self.names) - len(prior)
        of_errors = other.information[k:, k:] + np.diag(prior)
        other_right = np.column_stack([other.information[k:, :k], other.right[k:]])
        known = np.linalg.solve(of_errors, other_right)
        change, centre = known[:, :-1], known[:, -1]
        own, mixed = self.information[k:, k:], self.information[:k, k:]
        turned = mixed - change.T @ own
        information = self.information.copy()
        information[:k, :k] += change.T @ own @ change - mixed @ change - change.T @ mixed.T
        information[:k, k:], information[k:, :k] = turned, turned.T
        information[k:, k:] += other.information[k:, k:]
        right = np.append(
            self.right[:k] - change.T @ self.right[k:] - turned @ centre,
            self.right[k:] - own @ centre,
        )
        chi_squared = self.chi_squared + float(centre @ (own @ centre - 2 * self.right[k:]))
        return replace(
            self, information=information, right=right, chi_squared=chi_squared
        ).eliminated(prior)

    def estimate(self, chosen: Sequence[int]) -> tuple[Array, Array]:
        """Values and covariance of the chosen columns; NaN for unobservable ones."""
        values, directions, unobservable = self._modes(chosen)
        covariance = (directions / values) @ directions.T
        beta = covariance @ self.right[list(chosen)]
        hidden = unobservable[:, None] | unobservable[None, :]
        return np.where(unobservable, np.nan, beta), np.where(hidden, np.nan, covariance)

    def _modes(self, chosen: Sequence[int]) -> tuple[Array, Array, Booleans]:
        """The observable combinations of the chosen columns.

        Returns
        -------
        their information (m,), the combinations (k, m), and which columns they do not span (k,)
        """
        block = self.information[np.ix_(chosen, chosen)]
        size = _sizes(block)
        values, vectors = np.linalg.eigh(block / np.outer(size, size))
        observable = values > MIN_INFORMATION_SHARE
        spanned = np.sum(vectors[:, observable] ** 2, axis=1)
        directions = vectors[:, observable] / size[:, None]
        return values[observable], directions, spanned < MIN_SPANNED_SHARE


def whitening(information: Array, least: float = MIN_INFORMATION_SHARE) -> Array:
    """Combinations W (k, m) of the parameters of unit information, Wᵀ F W = 1.

    `least`: of the information scaled to unit diagonal, below which one is not observable.
    """
    size = _sizes(information)
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    observable = values > least
    return np.asarray(vectors[:, observable] / np.sqrt(values[observable]) / size[:, None])


def _sizes(information: Array) -> Array:
    """The roots of the diagonal, (k,), infinite where there is none: no combination has such."""
    own = np.diag(information)
    return np.sqrt(np.where(own > 0, own, np.inf))


# ---- From the rows of all unknowns to the normal equations of the effects.


class NormalEquations:
    """Takes the equations of a sensor some rows at a time.

    Rows that hold unknowns other than effects are made triangular, so that rounding is not squared
    there; the others, as many as there are observations, become normal equations.

    names, prior_sigma : (p,), of the unknowns
    """

    def __init__(self, names: Sequence[Name], prior_sigma: Array) -> None:
        are_effects = np.array([kind == "effect" for kind, _ in names], bool)
        effects, others = np.flatnonzero(are_effects), np.flatnonzero(~are_effects)
        self._names = tuple(name for kind, name in names if kind == "effect")
        self._order = np.concatenate([others, effects, [len(names)]])
        self._sigma = prior_sigma[others]
        # The prior of an unknown is an observation.
        self._pending = [np.eye(len(others), len(names) + 1)]
        self._squares = np.zeros((len(effects) + 1, len(effects) + 1))
        self.raw = np.zeros(len(effects))  # information of each column, nothing else fitted

    def add(self, rows: Array) -> None:
        """Rows in units of sigma about the priors, (n, p + 1), the last column the observations."""
        ordered, others = rows[:, self._order], len(self._sigma)
        ordered[:, :others] *= self._sigma
        self.raw += np.sum(ordered[:, others:-1] ** 2, axis=0)
        self._pending.append(ordered)
        if sum(map(len, self._pending)) > MIN_ROWS_PER_PRODUCT:
            self._multiply()

    def information(self, count: int, parameters: int) -> EffectInformation:
        """The normal equations of the effects, all other unknowns fitted.

        Chi-squared is that of `count` observations and errors. The vague priors of the first
        `parameters` are none of either: a cross term of 2.5 % is a third of its σ, and beside
        residuals in units of a scatter that they are all of, that would stand where an effect
        leaves nothing.
        """
        self._multiply()
        (upper,), others = self._pending, len(self._sigma)
        fitted = solve_triangular(upper[:, :others], upper[:, -1])
        vague = float(np.sum(fitted[:parameters] ** 2))
        return EffectInformation(
            self._names,
            self._squares[:-1, :-1],
            self._squares[:-1, -1],
            float(self._squares[-1, -1]) - vague,
            count - parameters,
        )

    def _multiply(self) -> None:
        others = len(self._sigma)
        factor = partial_r_factor(np.vstack(self._pending), others)
        below = factor[others:, others:]
        self._squares += below.T @ below
        self._pending = [factor[:others]]


# ---- Derivatives of readings with respect to the parameters of effects.


@dataclass(frozen=True)
class Sensitivities:
    """The change of a reading per unit of each parameter.

    `names`: of the parameters; `values`: (3, k), or (n, 3, k) for n blocks.
    """

    names: tuple[str, ...] = ()
    values: Array = field(default_factory=lambda: np.zeros((3, 0)))

    def of(self, names: Sequence[str]) -> Array:
        """Those to other parameters, in their order; zero for parameters that it does not have."""
        if tuple(names) == self.names:
            return self.values
        others = np.zeros((*self.values.shape[:-1], len(names)))
        there = [i for i, name in enumerate(names) if name in self.names]
        others[..., there] = self.values[..., [self.names.index(names[i]) for i in there]]
        return others

    def extended(self, names: Sequence[str], values: Array) -> "Sensitivities":
        """These and further ones."""
        every = np.concatenate([self.values, values], axis=-1)
        return Sensitivities((*self.names, *names), every)


NO_SENSITIVITIES = Sensitivities()
