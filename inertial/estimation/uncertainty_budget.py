"""Which source of error the variance of a parameter comes from.

The estimate of smallest variance is linear in independent errors, x = Σ_s A_s e_s, so its
covariance is C = Σ_s σ_s² A_s A_sᵀ. It does not change to first order with the weights, so the part
of a source is the derivative of C by its variance,

    σ_s² ∂C/∂σ_s²,

and all parts add up to C, for C is homogeneous in the variances (GUM 5.1.2, E.3; but for vague
priors, whose part is negligible).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.elimination import AZIMUTH, OF_AXIS, OF_CASE, TILTS
from inertial.estimation.triad import UNKNOWNS

STEP = 1e-4  # relative, of a variance: its square is lost, and nothing by rounding
# The kinds of the errors and of the known quantities in the equations.
ERRORS = {
    "position": (*TILTS, *OF_AXIS, *AZIMUTH, *OF_CASE),
    "angle": ("angle", "encoder delay", "encoder sine", "encoder cosine"),
    "rate": ("rate",),
    "table_rate": ("table rate",),
    "interpolation": ("gap angle",),
    "clock": ("clock",),
    "azimuth": ("level 0", "level 1", "earth 0", "earth 1", "earth 2"),
}
QUANTITIES = {"gravity": "gravity", "latitude": "earth"}
NOISE, DRIFT, SCATTER, WALK = "noise", "drift", "scatter", "random_walk"
SWITCH_ON = "switch_on"
SOURCES = (NOISE, DRIFT, SWITCH_ON, SCATTER, WALK, *ERRORS, *QUANTITIES)


@dataclass(frozen=True)
class Model:
    """The equations of one sensor with its scatter and random walk, units of the readings."""

    equations: DriftingEquations
    scatter: float = 0.0
    walk: float = 0.0

    @property
    def variances(self) -> Array:
        """Of M by rows and bias, (12,)."""
        estimate = self.equations.system(self.scatter, self.walk).solve_shared()
        return np.diag(estimate.covariance)[:UNKNOWNS]

    def noisier(self, source: str, factor: float) -> "Model":
        """The same with the standard deviation of one source multiplied."""
        own, equations = ERRORS.get(source, ()), self.equations
        if source == SCATTER:
            return replace(self, scatter=factor * self.scatter)
        if source == WALK:
            return replace(self, walk=factor * self.walk)
        if source == NOISE:
            blocks = [
                (replace(block, rows=block.rows / factor), stretch)
                for block, stretch in equations.blocks
            ]
            return replace(self, equations=replace(equations, blocks=blocks))
        if source == DRIFT:
            drift = equations.measured
            larger = replace(
                drift, instability=factor * drift.instability, walk=factor * drift.walk
            )
            return replace(self, equations=replace(equations, measured=larger))
        if source == SWITCH_ON:
            drift = equations.measured
            assert drift.switch_on is not None  # else it has no such errors
            larger = replace(drift, switch_on=factor * drift.switch_on)
            return replace(self, equations=replace(equations, measured=larger))
        sigma = {
            name: (factor if name[0] in own else 1.0) * size
            for name, size in equations.sigma.items()
        }
        wanted = {*own, QUANTITIES.get(source)}
        of_kind = [kind in wanted for kind, _name in equations.names]
        prior_sigma = np.where(of_kind, factor, 1.0) * equations.prior_sigma
        return replace(self, equations=replace(equations, sigma=sigma, prior_sigma=prior_sigma))

    def has(self, source: str) -> bool:
        """Whether the equations hold such errors."""
        there = {
            NOISE: True,
            DRIFT: bool(self.equations.measured),
            SWITCH_ON: self.equations.measured.differs([s for _, s in self.equations.blocks]),
            SCATTER: self.scatter > 0,
            WALK: self.walk > 0,
        }
        kinds = {kind for kind, _name in (*self.equations.sigma, *self.equations.names)}
        wanted = {QUANTITIES[source]} if source in QUANTITIES else {*ERRORS.get(source, ())}
        return there.get(source, bool(kinds & wanted))


def budget(model: Model) -> tuple[Array, Mapping[str, Array]]:
    """The variances of M by rows and bias, and the part of each source in them, (12,) each."""
    whole = model.variances
    factor = np.sqrt(1 + STEP)
    parts = {
        source: (model.noisier(source, factor).variances - whole) / STEP
        for source in SOURCES
        if model.has(source)
    }
    return whole, parts
