"""Variance components of a parameter over several calibrations, by restricted likelihood.

n values y with known sigmas of their own differ by more than these: by the day, the mounting, the
switch-on, as groups of calibrations that share one. With Z_c the groups of a component,

    V = diag(σ²) + L Lᵀ + Σ τ_c² Z_c Z_cᵀ

L is what the errors of references that several of them share move each by; the τ_c are those of
largest restricted likelihood (Patterson & Thompson 1971), with the sigma of the expected
information, ½ tr(P Z_c Z_cᵀ P Z_d Z_dᵀ), and an upper limit by the profile of the likelihood
(Searle, Casella & McCulloch, Variance Components, 1992, chapter 6).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize

from inertial.arrays import Array

ONE_SIDED = 2.706  # rise of the deviance at the one-sided limit of 95 %
MIN_VALUES = 2
STARTS = (0.05, 0.5)  # of the search, in spreads of the values
LARGEST = 1e3  # upper limit that is sought, in spreads of the values


@dataclass(frozen=True)
class Component:
    """A standard deviation between groups; `names`: of what is alike in each of the `groups`.

    `sigma`: NaN where the largest likelihood is at zero; `upper`: one-sided 95 %.
    """

    names: tuple[str, ...]
    groups: int
    value: float
    sigma: float
    upper: float


@dataclass(frozen=True)
class Components:
    """What the values show; `one`: names of which there is a single group, so nothing is known."""

    found: Sequence[Component]
    one: tuple[str, ...]


def components(
    values: Array,
    sigma: Array,
    alike: Mapping[str, Sequence[str]],
    shared: Array | None = None,
) -> Components:
    """The components of n values with their sigmas, (n,).

    What divides the values in the same way is one component: nothing tells its parts apart.

    Parameters
    ----------
    alike : name of a component → the group of each value
    shared : (n, r), by how much a standard deviation of r common errors moves each value
    """
    divisions: dict[tuple[int, ...], list[str]] = {}
    for name, labels in alike.items():
        places = {label: place for place, label in enumerate(dict.fromkeys(labels))}
        divisions.setdefault(tuple(places[label] for label in labels), []).append(name)
    one = tuple(divisions.pop((0,) * len(values), ()))
    squares = [np.equal.outer(np.array(d), np.array(d)).astype(float) for d in divisions]
    if not squares or len(values) < MIN_VALUES:
        return Components([], one)
    spread = float(np.ptp(values) + np.sqrt(np.mean(sigma**2)))
    common = np.zeros((len(values), 0)) if shared is None else shared
    errors = (np.diag(sigma**2) + common @ common.T) / spread**2
    model = _Restricted(values / spread, errors, squares)
    best, smallest = model.largest()
    errors = model.sigmas(best)
    found = [
        Component(
            tuple(names),
            max(division) + 1,
            spread * float(best[i]),
            spread * float(errors[i]),
            spread * model.upper(i, best, smallest),
        )
        for i, (division, names) in enumerate(divisions.items())
    ]
    return Components(found, one)


class _Restricted:
    """The restricted likelihood of values about a common mean; sizes in units of the spread."""

    def __init__(self, values: Array, errors: Array, squares: Sequence[Array]) -> None:
        self.values, self.own, self.squares = values, errors, squares

    def projection(self, sizes: Array) -> tuple[Array, float]:
        """P = V⁻¹ less the mean, and log |V| + log (1ᵀ V⁻¹ 1)."""
        covariance = self.own + sum(
            size**2 * square for size, square in zip(sizes, self.squares, strict=True)
        )
        inverse = np.linalg.inv(covariance)
        weights = inverse.sum(axis=0)
        logarithm = float(np.linalg.slogdet(covariance)[1] + np.log(weights.sum()))
        return inverse - np.outer(weights, weights) / weights.sum(), logarithm

    def deviance(self, sizes: Array) -> tuple[float, Array]:
        """−2 log likelihood, and its derivative by each size."""
        projection, logarithm = self.projection(sizes)
        residual = projection @ self.values
        by_variance = [
            np.sum(projection * square) - residual @ square @ residual for square in self.squares
        ]
        return float(self.values @ residual + logarithm), 2 * sizes * np.array(by_variance)

    def largest(self, kept: tuple[int, float] | None = None) -> tuple[Array, float]:
        """The sizes of smallest deviance, one of them `kept` where it is given."""
        count = len(self.squares)
        bounds = [(0.0, LARGEST)] * count
        if kept is not None:
            bounds[kept[0]] = (kept[1], kept[1])
        fits = [
            minimize(
                self.deviance,
                np.clip(np.full(count, start), *np.transpose(bounds)),
                jac=True,
                method="L-BFGS-B",
                bounds=bounds,
            )
            for start in STARTS
        ]
        best = min(fits, key=lambda fit: float(fit.fun))
        return np.asarray(best.x), float(best.fun)

    def sigmas(self, sizes: Array) -> Array:
        """Of each size by the expected information of the variances; NaN at zero."""
        inside = [i for i, size in enumerate(sizes) if size > 0]
        result = np.full(len(sizes), np.nan)
        if not inside:
            return result
        projection, _logarithm = self.projection(sizes)
        scaled = [projection @ self.squares[i] for i in inside]
        information = np.array([[np.sum(a * b.T) / 2 for a in scaled] for b in scaled])
        variance = np.diagonal(np.linalg.pinv(information))
        result[inside] = np.sqrt(variance) / (2 * sizes[inside])
        return result

    def upper(self, i: int, best: Array, smallest: float) -> float:
        """The size above the best at which the profile of the deviance has risen to the limit."""

        def rise(size: float) -> float:
            return self.largest((i, size))[1] - smallest - ONE_SIDED

        low = float(best[i])
        high = max(2 * low, 0.1)
        while rise(high) < 0:
            if high > LARGEST / 4:
                return float("inf")
            low, high = high, 4 * high
        return float(brentq(rise, low, high, rtol=1e-3))
