"""Normal equations of effects alone, all other unknowns eliminated.

On them rest the statistics of every effect, or set of effects: how much of chi-squared it explains,
its values with their covariance, and the same beside others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

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

    def with_rows(self, rows: Array) -> "EffectInformation":
        """The same with further equations of the effects alone, (n, k + 1), in units of sigma."""
        design, observed = rows[:, :-1], rows[:, -1]
        return replace(
            self,
            information=self.information + design.T @ design,
            right=self.right + design.T @ observed,
            chi_squared=self.chi_squared + float(observed @ observed),
        )

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
        size = sizes_of(block)
        values, vectors = np.linalg.eigh(block / np.outer(size, size))
        observable = values > MIN_INFORMATION_SHARE
        spanned = np.sum(vectors[:, observable] ** 2, axis=1)
        directions = vectors[:, observable] / size[:, None]
        return values[observable], directions, spanned < MIN_SPANNED_SHARE


def whitening(information: Array, least: float = MIN_INFORMATION_SHARE) -> Array:
    """Combinations W (k, m) of the parameters of unit information, Wᵀ F W = 1.

    `least`: of the information scaled to unit diagonal, below which one is not observable.
    """
    size = sizes_of(information)
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    observable = values > least
    return np.asarray(vectors[:, observable] / np.sqrt(values[observable]) / size[:, None])


def sizes_of(information: Array) -> Array:
    """The roots of the diagonal, (k,), infinite where there is none: no combination has such."""
    own = np.diag(information)
    return np.sqrt(np.where(own > 0, own, np.inf))


# ---- From the rows of all unknowns to the normal equations of the effects.


class NormalEquations:
    """Takes the equations of a sensor some rows at a time.

    Rows that hold unknowns other than effects are made triangular, so that rounding is not squared
    there; the others, as many as there are observations, become normal equations.

    names, prior_sigma : (p,), of the unknowns
    errors : how many of the last unknowns are errors that another sensor shows, too; they are free
    """

    def __init__(self, names: Sequence[Name], prior_sigma: Array, errors: int = 0) -> None:
        last = len(names) - errors
        are_effects = np.array([kind == "effect" for kind, _ in names[:last]], bool)
        effects, others = np.flatnonzero(are_effects), np.flatnonzero(~are_effects)
        self._names = tuple(name for kind, name in names[:last] if kind == "effect")
        self._order = np.concatenate([others, np.arange(last, len(names)), effects, [len(names)]])
        self._sigma = prior_sigma[others]
        self._fitted = len(others) + errors
        # The prior of an unknown is an observation.
        self._pending = [np.eye(len(others), len(names) + 1)]
        self._squares = np.zeros((len(effects) + 1, len(effects) + 1))
        self._raw = np.zeros(len(effects))

    def add(self, rows: Array) -> None:
        """Rows in units of sigma about the priors, (n, p + 1), the last column the observations."""
        ordered = rows[:, self._order]
        ordered[:, : len(self._sigma)] *= self._sigma
        self._raw += np.sum(ordered[:, self._fitted : -1] ** 2, axis=0)
        self._pending.append(ordered)
        if sum(map(len, self._pending)) > MIN_ROWS_PER_PRODUCT:
            self._multiply()

    def information(self, count: int, parameters: int) -> "SensorInformation":
        """What the equations say of the effects, all other unknowns fitted.

        Chi-squared is that of `count` observations and errors. The vague priors of the first
        `parameters` are none of either: a cross term of 2.5 % is a third of its σ, and beside
        residuals in units of a scatter that they are all of, that would stand where an effect
        leaves nothing.
        """
        self._multiply()
        (upper,), others = self._pending, len(self._sigma)
        fitted = solve_triangular(upper[:others, :others], upper[:others, -1])
        vague = float(np.sum(fitted[:parameters] ** 2))
        on_effects = EffectInformation(
            self._names,
            self._squares[:-1, :-1],
            self._squares[:-1, -1],
            float(self._squares[-1, -1]) - vague,
            count - parameters,
        )
        return SensorInformation(on_effects, self._raw, upper[others:, others:])

    def _multiply(self) -> None:
        upper, below = split(np.vstack(self._pending), self._fitted)
        self._squares += below.T @ below
        self._pending = [upper]


class SensorInformation(NamedTuple):
    """What a sensor says of k effects and t errors that another sensor shows, too.

    `on_effects`: the errors fitted; `raw`: (k,), information on each effect, nothing else fitted;
    `on_errors`: (t, t + k + 1), rows of the errors, triangular, with effects and observations.
    """

    on_effects: EffectInformation
    raw: Array
    on_errors: Array


def split(rows: Array, first: int) -> tuple[Array, Array]:
    """Rows that make the first unknowns triangular, and those of the others alone."""
    factor = partial_r_factor(rows, first)
    return factor[:first], factor[first:, first:]


def with_prior(on_errors: Array, prior: Array) -> Array:
    """The rows, and that errors are zero with the information `prior`, (t,)."""
    of_prior = np.zeros((len(prior), on_errors.shape[1]))
    of_prior[:, : len(prior)] = np.diag(np.sqrt(prior))
    return np.vstack([on_errors, of_prior])


def deviance_as_errors(on_errors: Array, prior: Array) -> float:
    """−2 log of the likelihood of rows without effects, (n, t + 1), as errors; less that of none.

    `prior`: (t,), information on the errors beforehand.
    """
    upper, rest = split(with_prior(on_errors, prior), len(prior))
    log_det = 2 * np.sum(np.log(np.abs(np.diag(upper)))) - np.sum(np.log(prior))
    return float(log_det + np.sum(rest[:, -1] ** 2) - np.sum(on_errors[:, -1] ** 2))


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
