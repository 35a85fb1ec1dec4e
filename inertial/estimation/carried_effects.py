"""The motions between rests of unknown attitude, with what effects do to them.

The equations of `between_positions` with the parameters of effects as further unknowns.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation import multi_position as forces
from inertial.estimation.attitude import Passage
from inertial.estimation.between_positions import (
    Prior,
    Rows,
    Stop,
    Unknowns,
    rows_of_forces,
    rows_of_rates,
)
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.effect_information import Sensitivities
from inertial.estimation.elimination import EquationBlock, whitened
from inertial.estimation.multi_position import upward_of
from inertial.estimation.random_walk import Stretch
from inertial.estimation.scatter_and_random_walk import Scatter
from inertial.estimation.triad import UNKNOWNS


@dataclass(frozen=True)
class Carried:
    """What effects do to each stop and to the motion after it, and when these were.

    `at_stops`: (3, k) of each stop; `moving`: (s, 3, k) of each passage in its stretches;
    `stretches`: of time, of the stops, then of the passages.
    """

    at_stops: Sequence[Sensitivities]
    moving: Sequence[Sensitivities]
    stretches: Sequence[Stretch]


@dataclass(frozen=True)
class CarriedEquations:
    """The equations with parameters of effects as further unknowns, before any scatter.

    `forces`: those of the accelerometers; `rates`: of each stop and passage by number, of which the
    last column is the observation, both about the priors; `effect_sigma`: of their priors.
    """

    data: Unknowns
    forces: EquationBlock
    rates: Mapping[int, Rows]
    stretches: Sequence[Stretch]
    effect_sigma: Mapping[str, float]

    def drifting(self, scatter: Scatter, used: Sequence[bool]) -> DriftingEquations:
        """In blocks; `used`: of each stop, then of each passage, whether its gyros are."""
        data, blocks = self.data, [(self.forces, Stretch("forces"))]
        for number, rows in self.rates.items():
            if used[number]:
                rate = scatter.of_rate(rows.seconds, data.usual)
                turn, sigma = rows.independent(rate, scatter.swing)
                blocks.append((whitened(turn @ rows.design, sigma, ()), self.stretches[number]))
        return DriftingEquations(
            blocks,
            [stretch.name for _, stretch in blocks],
            {},
            np.append(data.prior, np.zeros(len(self.effect_sigma))),
            np.append(data.prior_sigma, list(self.effect_sigma.values())),
            (*data.names, *(("effect", name) for name in self.effect_sigma)),
            UNKNOWNS - 3,
            data.parameters,
        )


def carried_equations(
    stops: Sequence[Stop],
    passages: Sequence[Passage],
    known: Prior,
    about: tuple[Array, Array, Array, Array],
    carried: Carried,
    effect_sigma: Mapping[str, float],
) -> CarriedEquations:
    """Linear about M and bias of the gyros, then P and bias of the accelerometers, `about`."""
    matrix, bias, symmetric, force_bias = about
    means = np.array([stop.forces.mean for stop in stops])
    up = upward_of((means - force_bias) @ np.linalg.inv(symmetric).T)
    data = Unknowns(stops, passages, known, up)
    around = data.prior
    pairs = [symmetric[i, j] for i, j in forces.PAIRS]
    around[: UNKNOWNS + forces.FREE] = [*matrix.ravel(), *bias, *pairs, *force_bias]
    effects = list(effect_sigma)
    answers = [each.of(effects)[None] for each in carried.at_stops]
    answers += [each.of(effects) for each in carried.moving]

    def stacked(design: Array, rest: Array, of_effects: Array) -> Array:
        observed = rest + design @ (around - data.prior)
        return np.column_stack([design, of_effects, observed])

    design, rest, sigma = rows_of_forces(data, around)
    of_forces = stacked(design, rest, np.zeros((len(rest), len(effects))))
    rates = {}
    for number, rows in rows_of_rates(data, around):
        of_effects = np.einsum("msi,sik->mk", rows.response, answers[number])
        rates[number] = replace(rows, design=stacked(rows.design, rows.rest, of_effects))
    return CarriedEquations(
        data, whitened(of_forces, sigma, ()), rates, carried.stretches, effect_sigma
    )
