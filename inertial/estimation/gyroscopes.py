"""The gyros from static positions and rate segments of a known angle, all nine elements of M."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.elimination import EquationBlock, Name
from inertial.estimation.gyroscope_equations import (
    Linearisation,
    segment_equations,
    static_equations,
    steady_equations,
)
from inertial.estimation.gyroscope_observations import (
    EARTH_UP,
    Earth,
    RateSegment,
    StaticRate,
    SteadyRate,
    WholeTurn,
)
from inertial.estimation.horizontal_earth_rate import known_azimuths, size_constraint
from inertial.estimation.least_squares import Estimate, System, solve
from inertial.estimation.random_walk import NO_DRIFT, MeasuredDrift, Stretch
from inertial.estimation.scatter_and_random_walk import ScatterFit, walk_search
from inertial.estimation.triad import UNKNOWNS

# Vague priors: M within 0.1 of the unit matrix, the bias within 1 rad/s. Without rate segments only
# the earth's rate determines M, and a wider prior would let an absurd M fit an unknown azimuth.
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.full(9, 0.1), np.full(3, 1.0))
ITERATIONS = 5  # linearisations about the last result
BIAS = 9  # column of the first of the three biases
MAX_RANDOM_WALK = 8e-5  # rad/s/√s, 1000 °/h/√h: a hundred times that of the poorest gyros
SCATTER_BOUNDS = (1e-11, 0.1)  # rad/s, between manoeuvres beyond the noise


def bias_and_scale(turns: Sequence[WholeTurn], earth: Earth, scatter: float = 0.0) -> Estimate:
    """Bias and scale factor error of one gyro from turns about its axis, forward and backward.

    α̃ = b t + (1 + s) α + ω_e sinφ t for each turn; for one forward and one backward turn over
    equal times this is S0 (3-9), (3-10): b = (α̃₁+α̃₂)/(2t) − ω_e sinφ, s = (α̃₁−α̃₂)/(2α) − 1.
    Unknowns: b, s, the upward earth rate, the rates of the logs' clocks. `scatter` as in `joint`.
    """
    seconds = np.array([turn.seconds for turn in turns])
    angles = np.array([turn.angle for turn in turns])
    up = np.array([turn.up for turn in turns])
    summed = np.array([turn.summed for turn in turns])
    variance = [turn.density**2 * turn.seconds + turn.angle_sigma**2 for turn in turns]
    sigma = np.sqrt(variance + (scatter * seconds) ** 2)
    clocks = {turn.clock: turn.clock_sigma for turn in turns if turn.clock_sigma}
    timed = [angles * np.array([turn.clock == clock for turn in turns]) for clock in clocks]
    design = np.column_stack([seconds, angles, up * seconds, *timed])
    prior = np.append([0.0, 0.0, earth.up], np.zeros(len(clocks)))
    prior_sigma = np.array([1.0, 1.0, earth.up_sigma, *clocks.values()])
    return solve(design, summed - angles, sigma, prior, prior_sigma, 2)


def joint(
    statics: Sequence[StaticRate],
    segments: Sequence[RateSegment],
    steadies: Sequence[SteadyRate],
    earth: Earth,
    position_sigma: float,
    scatter: float = 0.0,
    walk: float = 0.0,
    measured: MeasuredDrift = NO_DRIFT,
) -> Estimate:
    """Bias and M of the gyros from all static positions and rate segments at once.

    `scatter`, rad/s: of the readings between manoeuvres, beyond noise; `walk`, rad/s/√s: random
    walk of the bias, see `random_walk`; both beyond the `measured` drift.

    The equations hold products of M with the errors, so they are solved `ITERATIONS` times, each
    time about the last result; so is the constraint on the horizontal earth rate.
    """
    point = Linearisation(np.eye(3), _median_rate(statics), {})
    for _ in range(ITERATIONS):
        equations = linearised(point, segments, steadies, earth, position_sigma, None, measured)
        estimate = equations.system(statics, scatter, walk).solve()
        point = linearisation_at(estimate, earth)
    return estimate


def fit(
    statics: Sequence[StaticRate],
    segments: Sequence[RateSegment],
    steadies: Sequence[SteadyRate],
    earth: Earth,
    position_sigma: float,
    noise_degrees: float = np.inf,
    measured: MeasuredDrift = NO_DRIFT,
) -> ScatterFit:
    """The joint fit with the scatter and random walk of largest restricted likelihood."""
    others = (segments, steadies, earth, position_sigma)
    estimate = joint(statics, *others, measured=measured)
    equations = linearised(linearisation_at(estimate, earth), *others, None, measured)

    drifting = equations.with_statics(statics).drifting()
    likelihood = drifting.likelihood
    if measured.switch_on is None and (switched := likelihood.switch_ons()) is not None:
        known = replace(measured, switch_on=switched.covering)
        return replace(fit(statics, *others, noise_degrees, known), switch_ons=switched)

    def fit_with(scatter: float, walk: float) -> Estimate:
        return drifting.system(scatter, walk).solve_shared()

    every: list[StaticRate | RateSegment | SteadyRate] = [*statics, *segments, *steadies]
    ups = {item.position.name: str(np.round(item.position.up, 3)) for item in every}
    attitudes = [ups[position] for position in likelihood.positions]
    stretches = [item.stretch for item in every if item.stretch is not None]
    sigmas = [item.sigma for item in every if not isinstance(item, RateSegment)]
    noise = float(np.nanmedian([*sigmas, np.full(3, np.nan)])) if sigmas else 0.0
    search = walk_search(stretches, noise, MAX_RANDOM_WALK)
    times, bounds = (stretches, search), SCATTER_BOUNDS
    alone = likelihood.of_scatter(likelihood.stretches)
    result = likelihood.fitted(fit_with, alone, attitudes, *times, bounds, noise_degrees)
    if result.scatter or result.random_walk:
        estimate = joint(statics, *others, result.scatter, result.random_walk, measured)
    return replace(result, estimate=estimate)


def linearisation_at(estimate: Estimate, earth: Earth) -> Linearisation:
    """The linearisation about an estimate."""
    values = estimate.values
    levels = dict(zip(estimate.names, values.tolist(), strict=True))
    sigmas = dict(zip(estimate.names, estimate.sigma.tolist(), strict=True))
    azimuths = known_azimuths(sigmas, earth)
    return Linearisation(values[:9].reshape(3, 3), values[9:12], levels, azimuths)


def _median_rate(statics: Sequence[StaticRate]) -> Array:
    """First estimate of the bias, (3,)."""
    if not statics:
        return np.zeros(3)
    recorded = [column[np.isfinite(column)] for column in np.array([s.mean for s in statics]).T]
    return np.array([np.median(rates) if len(rates) else 0.0 for rates in recorded])


@dataclass(frozen=True)
class LinearisedEquations:
    """The equations of rate segments, to which those of static positions are added.

    `blocks`: with the position and the stretch of each, None of a segment that no gyro senses;
    `sigma`: of the errors; `effect_sigma`: prior sigmas of the parameters of effects;
    `level_changes`: of those that change it, what the size of the earth's horizontal rate changes
    by per unit; `measured`: drift of the biases.
    """

    point: Linearisation
    earth: Earth
    effect_sigma: Mapping[str, float]
    blocks: Sequence[tuple[str, EquationBlock, Stretch] | None]
    sigma: Mapping[Name, float]
    measured: MeasuredDrift = NO_DRIFT
    level_changes: Mapping[str, float] = field(default_factory=dict)

    def with_statics(self, statics: Sequence[StaticRate]) -> "LinearisedEquations":
        """The same with the equations of static positions, before the others."""
        prior, effects, sigma = self._prior, list(self.effect_sigma), dict(self.sigma)
        static = static_equations(statics, self.point, self.earth, prior, effects, sigma)
        return replace(self, blocks=[*static, *self.blocks], sigma=sigma)

    def only(self, used: Sequence[bool]) -> "LinearisedEquations":
        """Some of the blocks; `used`: of each, whether it is."""
        blocks = [block for block, there in zip(self.blocks, used, strict=True) if there]
        return replace(self, blocks=blocks)

    @property
    def _prior(self) -> Array:
        return np.concatenate([PRIOR, [self.earth.up], np.zeros(len(self.effect_sigma))])

    def drifting(self) -> DriftingEquations:
        """All equations. Unknowns: M by rows, bias, upward earth rate, effects."""
        prior, sigma = self._prior, dict(self.sigma)
        by_position: dict[str, list[tuple[EquationBlock, Stretch]]] = {}
        changes = [self.level_changes.get(name, 0.0) for name in self.effect_sigma]
        constrained = size_constraint(self.point, self.earth, changes, sigma)
        for position, block, stretch in filter(None, self.blocks):
            by_position.setdefault(position, []).append((constrained(block), stretch))
        names = [("parameter", str(i)) for i in range(UNKNOWNS)]
        names += [EARTH_UP, *(("effect", name) for name in self.effect_sigma)]
        return DriftingEquations(
            [pair for pairs in by_position.values() for pair in pairs],
            [position for position, pairs in by_position.items() for _ in pairs],
            sigma,
            prior,
            np.array([*PRIOR_SIGMA, self.earth.up_sigma, *self.effect_sigma.values()]),
            tuple(names),
            BIAS,
            measured=self.measured,
        )

    def system(
        self, statics: Sequence[StaticRate], scatter: float = 0.0, walk: float = 0.0
    ) -> System:
        """All equations and those of static positions; `scatter`, `walk`: as in `joint`."""
        return self.with_statics(statics).drifting().system(scatter, walk)


def linearised(
    point: Linearisation,
    segments: Sequence[RateSegment],
    steadies: Sequence[SteadyRate],
    earth: Earth,
    position_sigma: float,
    effect_sigma: Mapping[str, float] | None = None,
    measured: MeasuredDrift = NO_DRIFT,
) -> LinearisedEquations:
    """The equations of rate segments and steady rates, linear about `point`.

    `position_sigma`: of the positions, rad; `effect_sigma`: of parameters of effects, which are
    unknowns too; `measured`: drift of the biases.
    """
    effect_sigma = effect_sigma or {}
    prior = np.concatenate([PRIOR, [earth.up], np.zeros(len(effect_sigma))])
    sigma: dict[Name, float] = {}
    common = (earth, position_sigma, prior, list(effect_sigma), sigma)
    blocks: list[tuple[str, EquationBlock, Stretch] | None] = []
    for number, segment in enumerate(segments):
        name = f"{segment.position.name} {number}"
        block = segment_equations(segment, name, point, *common, measured.instability)
        stretch = segment.stretch or Stretch(name)
        blocks.append(None if block is None else (segment.position.name, block, stretch))
    for number, steady in enumerate(steadies):
        name = f"{steady.position.name} {number}"
        block = steady_equations(steady, name, point.matrix, *common)
        stretch = steady.stretch or Stretch(f"{name} (steady)")
        blocks.append((steady.position.name, block, stretch))
    return LinearisedEquations(point, earth, effect_sigma, blocks, sigma, measured)
