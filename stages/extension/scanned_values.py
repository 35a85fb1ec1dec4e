"""What the scanned value of an effect is uncertain by, in the covariance of the parameters.

A time constant is found by a scan, and the parameters are fitted beside it. As it is uncertain, so
are they: the derivative of the readings by it is one more unknown t, and the parameters θ get
C_θt C_tt⁻¹ C_tθ on top of their covariance, to first order.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from inertial.estimation.least_squares import System
from inertial.physics.effect import Array, Effect, Parameter, Reading, Truth
from inertial.physics.motion import Motion
from stages.extension.estimates import Solved
from stages.extension.models import PRIOR_SIGMA

STEP = 0.05  # of the scanned value, of the derivative


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
        self.name = f"{effect.name} by {effect.scan.name}"  # type: ignore[misc]
        unit = effect.scan.unit
        self.parameters = (  # type: ignore[misc]
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
    sigmas = np.sqrt(np.diag(solution.covariance + added)).tolist()
    rows = [
        row if row["sigma"] is None else {**row, "sigma": sigma}
        for row, sigma in zip(solution.rows, sigmas, strict=True)
    ]
    return replace(solution, rows=rows, covariance=solution.covariance + added)


def of_effect(effect: Effect) -> list[str]:
    """The parameters of an effect as the rows of a fit name them."""
    return [f"{effect.name}.{parameter.name}" for parameter in effect.parameters]
