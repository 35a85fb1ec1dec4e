"""The equations of a sensor whose bias drifts from stretch to stretch, and their likelihood.

The likelihood of a scatter or a random walk is asked for many sizes. With the drifts d as further
unknowns, all others eliminated, the equations say N d = r, and before them d ~ N(0, size² B Bᵀ). So
−2 log of the restricted likelihood is, up to a constant,

    log det(I + size² Bᵀ N B) − size² rᵀ B (I + size² Bᵀ N B)⁻¹ Bᵀ r,

for every size by the eigenvalues of one matrix (Patterson & Thompson 1971; Kang et al. 2008,
Efficient control of population structure in model organism association mapping).

A drift that was measured is known before: its covariance C = L Lᵀ is the same for every size. Then
the equations of what is beyond it are

    N − N L S⁻¹ Lᵀ N,   r − N L S⁻¹ Lᵀ r,   S = I + Lᵀ N L,

and −2 log of the likelihood without any is larger by log det S − rᵀ L S⁻¹ Lᵀ r.
"""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag, solve_triangular

from inertial.arrays import Array
from inertial.estimation.effect_information import NormalEquations, SensorInformation
from inertial.estimation.elimination import (
    EquationBlock,
    Name,
    eliminate,
    eliminate_into,
    partial_r_factor,
)
from inertial.estimation.least_squares import Estimate, System, remaining, solve
from inertial.estimation.random_walk import (
    NO_DRIFT,
    MeasuredDrift,
    Stretch,
    linear_trend,
    measured_covariance,
    walk_covariance,
    with_drifts,
)
from inertial.estimation.scatter_and_random_walk import (
    Deviance,
    Deviances,
    ScatterFit,
    SwitchOns,
    WalkSearch,
    between,
    with_random_walk,
)
from inertial.estimation.triad import UNKNOWNS


@dataclass(frozen=True)
class DriftingEquations:
    """Equations of one sensor, of which the bias may have a scatter or a random walk.

    `blocks`: in the order of their elimination, with the stretch of each; `positions`: of each;
    `sigma`: of the errors; `prior`, `prior_sigma`, `names`: of the shared unknowns; `bias`: the
    first of the three biases in them; `parameters`: how many of the first have vague priors;
    `measured`: the drift of the bias that is known from the noise.
    """

    blocks: Sequence[tuple[EquationBlock, Stretch]]
    positions: Sequence[str]
    sigma: Mapping[Name, float]
    prior: Array
    prior_sigma: Array
    names: tuple[tuple[str, str], ...]
    bias: int
    parameters: int = UNKNOWNS
    measured: MeasuredDrift = NO_DRIFT

    def system(self, scatter: float = 0.0, walk: float = 0.0) -> System:
        """All equations, the errors eliminated; unit of the readings, and the same per √s."""
        left = eliminate(*self._with_drifts(scatter, walk))
        return remaining(*left, self.prior, self.prior_sigma, self.parameters, self.names)

    def information(self, walk: float = 0.0, errors: Sequence[Name] = ()) -> SensorInformation:
        """What the equations say of the effects, and of errors that another sensor shows, too."""
        shared = self._sharing(errors)
        equations = NormalEquations(shared.names, shared.prior_sigma, len(errors))
        done = eliminate_into(equations.add, *shared._with_drifts(0.0, walk))
        return equations.information(done.count, self.parameters)

    def _with_drifts(
        self, scatter: float, walk: float
    ) -> tuple[Sequence[EquationBlock], int, Mapping[Name, float]]:
        """What `eliminate` takes."""
        shared = len(self.prior)
        drift = (scatter, walk, self.measured)
        blocks, drift_sigma = with_drifts(self.blocks, shared, self.bias, *drift)
        return blocks, shared, {**self.sigma, **drift_sigma}

    def _sharing(self, errors: Sequence[Name]) -> "DriftingEquations":
        """The same with these errors as the last unknowns, so that they are not eliminated."""
        if not errors:
            return self
        shared, count = len(self.prior), len(errors)
        blocks = []
        for block, stretch in self.blocks:
            own = [i for i, name in enumerate(block.own) if name not in errors]
            rows = np.zeros((len(block.rows), shared + count + len(own) + 1))
            rows[:, :shared], rows[:, -1] = block.rows[:, :shared], block.rows[:, -1]
            rows[:, shared + count : -1] = block.rows[:, [shared + i for i in own]]
            for i, name in enumerate(block.own):
                if name in errors:
                    rows[:, shared + errors.index(name)] = block.rows[:, shared + i]
            names = tuple(block.own[i] for i in own)
            blocks.append((replace(block, rows=rows, own=names), stretch))
        return replace(
            self,
            blocks=blocks,
            sigma={name: size for name, size in self.sigma.items() if name not in errors},
            prior=np.append(self.prior, np.zeros(count)),
            prior_sigma=np.append(self.prior_sigma, [self.sigma.get(name, 1.0) for name in errors]),
            names=(*self.names, *errors),
        )

    @cached_property
    def likelihood(self) -> "DriftLikelihood":
        """The likelihood of drifts, one in each block."""
        shared, count = len(self.prior), len(self.blocks)
        every = shared + 3 * count
        blocks = []
        for place, (block, _) in enumerate(self.blocks):
            rows = np.zeros((len(block.rows), block.rows.shape[1] + 3 * count))
            rows[:, :shared] = block.rows[:, :shared]
            drift = shared + 3 * place
            rows[:, drift : drift + 3] = block.rows[:, self.bias : self.bias + 3]
            rows[:, every:] = block.rows[:, shared:]
            blocks.append(EquationBlock(rows, block.own, block.count, block.deviance))
        rows, eliminated = eliminate(blocks, every, self.sigma)
        design, observed = rows[:, :shared], rows[:, -1] + rows[:, :shared] @ self.prior
        constant = solve(
            design, observed, np.ones(len(rows)), self.prior, self.prior_sigma, self.parameters
        )
        stacked = np.vstack([rows, np.eye(shared, every + 1)])
        stacked[: len(rows), :shared] *= self.prior_sigma
        corner = partial_r_factor(stacked, shared)[shared:, shared:]
        stretches = [stretch for _, stretch in self.blocks]
        return DriftLikelihood(
            stretches,
            self.positions,
            corner[:, :-1].T @ corner[:, :-1],
            corner[:, :-1].T @ corner[:, -1],
            constant.deviance + eliminated.deviance,
        ).beyond(self.measured)


@dataclass(frozen=True)
class DriftLikelihood:
    """−2 log of the restricted likelihood of drifts of the bias, up to a constant.

    `stretches`, `positions`: of the n blocks; `information`, (3n, 3n), `right`, (3n,): the normal
    equations of their drifts, all else eliminated; `constant`: the deviance of a constant bias.
    """

    stretches: Sequence[Stretch]
    positions: Sequence[str]
    information: Array
    right: Array
    constant: float

    def beyond(self, measured: MeasuredDrift) -> "DriftLikelihood":
        """The same of what is beyond a drift that was measured."""
        if not (measured or measured.differs(self.stretches)):
            return self
        spread = np.zeros_like(self.information)
        for axis, covariance in enumerate(measured_covariance(self.stretches, measured)):
            spread[axis::3, axis::3] = _root(covariance)
        carried = self.information @ spread
        lower = np.linalg.cholesky(np.eye(spread.shape[1]) + spread.T @ carried)
        half = solve_triangular(lower, carried.T, lower=True)
        known = solve_triangular(lower, spread.T @ self.right, lower=True)
        rise = 2 * float(np.sum(np.log(np.diag(lower)))) - float(known @ known)
        return replace(
            self,
            information=self.information - half.T @ half,
            right=self.right - half.T @ known,
            constant=self.constant + rise,
        )

    def of_scatter(
        self, names: Sequence[Hashable] | None = None, weights: Sequence[float] | None = None
    ) -> Deviance:
        """As a function of a scatter; blocks of one name share theirs, in proportion to a weight.

        Without names each block has its own.
        """
        named = range(len(self.stretches)) if names is None else names
        factor = _shared(named)
        return self._of(factor if weights is None else factor * np.array(weights)[:, None])

    def of_walk(self) -> Deviance:
        """As a function of a random walk alone."""
        return self._of(self._spread(0.0, 1.0))

    def of_both(self, scatter: float, walk: float) -> float:
        """With a scatter of each stretch and a random walk."""
        return self._of(self._spread(scatter, walk))(1.0)

    def fitted(
        self,
        fit: Callable[[float, float], Estimate],
        of_scatter: Deviance,
        attitudes: Sequence[str],
        stretches: Sequence[Stretch],
        search: WalkSearch | None,
        between: tuple[float, float],
        noise_degrees: float,
    ) -> ScatterFit:
        """The fit with the scatter and the random walk of largest restricted likelihood.

        What resembles a random walk are differences from position to position, from attitude to
        attitude, and a drift in proportion to time.

        Parameters
        ----------
        of_scatter : deviance as a function of a scatter alone
        attitudes : of the n blocks; `stretches`: with a time, all of the campaign
        fit, search, between, noise_degrees : as in `with_random_walk`
        """
        alternatives = [self.of_scatter(self.positions), self.of_scatter(attitudes)]
        if stretches:
            trend = list(map(linear_trend(stretches), self.stretches))
            names, weights = zip(*((s.name, s.weight) for s in trend), strict=True)
            alternatives.append(self.of_scatter(names, weights))
        likely = Deviances(of_scatter, self.of_walk(), self.of_both)
        return with_random_walk(fit, likely, between, search, alternatives, noise_degrees)

    def switch_ons(self) -> "SwitchOns | None":
        """By what the bias of each axis differs between switch-ons; None where there is one."""
        parts = [stretch.switch_on for stretch in self.stretches]
        count = len(set(parts))
        if count < 2:
            return None
        factor = _shared(parts)
        found = [
            between(
                factor.T @ self.information[axis::3, axis::3] @ factor,
                factor.T @ self.right[axis::3],
            )
            for axis in range(3)
        ]
        return SwitchOns(count, *np.array(found).T)

    def _spread(self, scatter: float, walk: float) -> Array:
        """B of the drifts of the blocks with a scatter of each stretch and a random walk."""
        own = list(dict.fromkeys(self.stretches))
        timed = [walk and np.isfinite(stretch.end) for stretch in own]
        inside = [stretch for stretch, there in zip(own, timed, strict=True) if there]
        outside = len(own) - len(inside)
        covariance = walk**2 * walk_covariance(inside) + scatter**2 * np.eye(len(inside))
        root = block_diag(_root(covariance), scatter * np.eye(outside))
        order = [*np.flatnonzero(timed), *np.flatnonzero(np.logical_not(timed))]
        spread = np.zeros_like(root)
        spread[order] = root
        return np.asarray(_shared(self.stretches) @ spread)

    def _of(self, factor: Array) -> Deviance:
        """As a function of the size of drifts `factor` · independent ones; the axes are alike."""
        n, q = factor.shape
        if not q:
            return lambda size: self.constant
        half = np.tensordot(factor.T, self.information.reshape(n, -1), 1)  # (q, 3 · 3n)
        whole = half.reshape(q, 3, n, 3).transpose(0, 1, 3, 2) @ factor  # (q, 3, 3, q)
        information = whole.transpose(0, 1, 3, 2).reshape(3 * q, 3 * q)
        values, vectors = np.linalg.eigh(information)
        values = np.maximum(values, 0.0)
        squares = (vectors.T @ (factor.T @ self.right.reshape(n, 3)).ravel()) ** 2

        def deviance(size: float) -> float:
            grown = size**2 * values
            drop = float(np.sum(size**2 * squares / (1 + grown)))
            return self.constant + float(np.sum(np.log1p(grown))) - drop

        return deviance


def _root(covariance: Array) -> Array:
    """L of a covariance L Lᵀ, which may be singular."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _shared(names: Sequence[Hashable]) -> Array:
    """Which block has which of the names, in the order of their first occurrence, (n, q)."""
    place = {name: i for i, name in enumerate(dict.fromkeys(names))}
    return np.asarray(np.eye(len(place))[[place[name] for name in names]])
