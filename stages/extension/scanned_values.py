"""What the scanned value of an effect is uncertain by, in the parameters and their covariance.

A time constant is found by a scan, and the parameters are fitted beside it. As it is uncertain, so
are they: the derivative of the readings by it is one more unknown t, and the parameters θ get
C_θt C_tt⁻¹ C_tθ on top of their covariance, to first order.

The moment of a jump has no such derivative, and where it may have been in either of two pauses the
parameters have two values: half a jump before +y up, with another scale factor, explains as much as
a whole one behind it. They are those of the mixture over all moments, by their likelihood.
"""

from collections.abc import Callable, Sequence
from types import MappingProxyType

import numpy as np

from inertial.arrays import Array
from inertial.estimation.least_squares import Estimate, System, with_columns
from inertial.estimation.mixture import mixture
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.effect import Effect, Parameter, Reading, Truth
from inertial.physics.motion import Motion
from stages.extension.estimates import Solved
from stages.extension.models import PRIOR_SIGMA, compressed

STEP = 0.05  # of the scanned value, of the derivative
NEAR = 1.5  # spacings of the moments, within which two are the same
MIN_SHARE = 1e-4  # of the likeliest: a moment that is less likely has no part


class ByScannedValue(Effect):
    """The readings of an effect of known size by its scanned value, whose sigma is its size.

    Of an effect that adds to the readings whatever is sensed.
    """

    cause = "unknown"
    source = "propagation of uncertainty to first order, JCGM 100:2008, 5.1"
    sizes = MappingProxyType({"usual": 1.0})

    def __init__(self, effect: Effect, values: Array) -> None:
        assert effect.scan is not None and effect.at is not None
        self.effect, self.values, self.size = effect, values, effect.at
        self.name = f"{effect.name} by {effect.scan.name}"
        unit = effect.scan.unit
        self.parameters = (
            Parameter(effect.scan.name, unit, self.size / PRIOR_SIGMA, effect.scan.meaning),
        )

    def signature(self, motion: Motion) -> Reading:
        nothing = np.zeros((len(motion.rate), 3))
        still, truth = Reading(nothing, nothing), Truth(nothing, nothing)
        after, before = (
            self.effect.fixed(self.size * part).reads(still, truth, motion, self.values)
            for part in (1 + STEP, 1 - STEP)
        )
        across = 2 * STEP * self.size
        return Reading(
            (after.gyro - before.gyro)[:, :, None] / across,
            (after.accel - before.accel)[:, :, None] / across,
        )


def with_scanned_values(
    solution: Solved, effects: Sequence[Effect], system_of: Callable[[Sequence[Effect]], System]
) -> Solved:
    """The fit with what the scanned values of its effects are uncertain by.

    `system_of`: the equations of the sensor with further effects.
    """
    values = {row["parameter"]: row["value"] for row in solution.of_effects}
    uncertain = [
        ByScannedValue(effect, np.array([values.get(name, 0.0) for name in of_effect(effect)]))
        for effect in effects
        if effect.scan is not None and effect.scan.smooth and effect.at is not None
    ]
    if not uncertain:
        return solution
    system = system_of(uncertain)
    covariance = system.solve_shared().covariance
    by_label = dict(pair for e in effects for pair in zip(e.columns, of_effect(e), strict=True))
    place = {by_label.get(name, name): i for i, (_kind, name) in enumerate(system.names)}
    scanned = [place[name] for effect in uncertain for name in effect.columns]
    own = [*range(len(solution.of_sensor)), *(place[r["parameter"]] for r in solution.of_effects)]
    shared = covariance[np.ix_(own, scanned)]
    added = shared @ np.linalg.solve(covariance[np.ix_(scanned, scanned)], shared.T)
    return solution.with_values(solution.values, solution.covariance + added)


def sets_in(effect: Effect) -> bool:
    """Whether it is there from a moment on that was searched."""
    scan = effect.scan
    return scan is not None and scan.name == "t0" and effect.at is not None


def over_moments(
    solution: Solved,
    uncertain: Sequence[Effect],
    effects: Sequence[Effect],
    of_both: Sequence[Effect],
    motion: Motion,
    system_of: Callable[[Sequence[Effect]], System],
) -> Solved:
    """The fit as the mixture over the moments at which its effects may have set in.

    `uncertain`: those of which this sensor is to tell the moment; `of_both`: the effects that were
    named in both sensors; `system_of`: as above. One moment is varied at a time, the others are
    those that were named; of several with one name none is.
    Only the parameters that the sensor shows at the moment named are unknown at the others.
    """
    beside = [other for other in of_both if sets_in(other)]
    names = [effect.name for effect in effects]
    for effect in uncertain:
        if sets_in(effect) and names.count(effect.name) == 1:
            solution = _over_moments_of(effect, effects, beside, solution, motion, system_of)
    return solution


def _over_moments_of(
    effect: Effect,
    effects: Sequence[Effect],
    beside: Sequence[Effect],
    solution: Solved,
    motion: Motion,
    system_of: Callable[[Sequence[Effect]], System],
) -> Solved:
    moments = [one for one in effect.candidates(motion) if one.label != effect.label]
    system = compressed(system_of(moments))
    scanned = {name for one in (effect, *moments) for name in one.columns}
    there = {name for kind, name in system.names if kind == "effect"}
    others = there - scanned
    shown = [i for i, name in enumerate(effect.columns) if name in there]
    seen = [i for i in shown if _determined(solution.estimate, effect.columns[i])]
    label = dict(pair for e in effects for pair in zip(of_effect(e), e.columns, strict=True))
    named = solution.estimate
    excess = max(1.0, named.chi_squared / max(named.degrees, 1))

    def fitted(one: Effect) -> tuple[float, Array, Array] | None:
        """Chi-squared, values and covariance in the order of the rows; None: not determined."""
        of_one = {effect.columns[i]: one.columns[i] for i in shown}
        fit = with_columns(system, frozenset({*others, *of_one.values()})).solve_shared()
        column = {name: i for i, (kind, name) in enumerate(fit.names) if kind == "effect"}
        wanted = [label[row["parameter"]] for row in solution.of_effects]
        own = [*range(UNKNOWNS), *(column[of_one.get(name, name)] for name in wanted)]
        if not all(_determined(fit, one.columns[i]) for i in seen):
            return None
        return fit.chi_squared, fit.values[own], fit.covariance[np.ix_(own, own)]

    before = fitted(effect)
    if before is None:
        return solution
    found = [(effect, before), *((one, fit) for one in moments if (fit := fitted(one)))]
    fits = [fit for _one, fit in found]
    least = min(chi_squared for chi_squared, *_ in fits)
    weights = np.exp([(least - chi_squared) / 2 / excess for chi_squared, *_ in fits])
    weights *= _shared_with([one for one, _fit in found], beside)
    weights[weights < MIN_SHARE * weights.max()] = 0.0
    values, covariances = (np.array([fit[k] for fit in fits]) for k in (1, 2))
    mean, covariance = mixture(values, covariances, weights)
    shift, added = mean - before[1], covariance - before[2]
    return solution.with_values(solution.values + shift, solution.covariance + added)


def _determined(fit: Estimate, column: str) -> bool:
    return bool(fit.determined[fit.names.index(("effect", column))])


def _shared_with(moments: Sequence[Effect], beside: Sequence[Effect]) -> Array:
    """How much likelier each moment is for what sets in at another one, (n,), not normalised.

    A knock or a restart changes both sensors, so a moment is as likely to be one of theirs as it is
    to be any.
    """
    at = np.array([one.at or 0.0 for one in moments])
    spacing = np.median(np.diff(np.unique(at))) if len(at) > 1 else 0.0
    odds = np.ones(len(at))
    for other in beside:
        if other.name != moments[0].name:
            near = np.abs(at - (other.at or 0.0)) < NEAR * spacing
            odds += near * len(at) / max(near.sum(), 1)
    return odds


def of_effect(effect: Effect) -> list[str]:
    """The parameters of an effect as the rows of a fit name them."""
    return [f"{effect.name}.{parameter.name}" for parameter in effect.parameters]
