"""Test of one set position for an error larger than the table's sigma, and its consequences.

The tilts of each position in turn are fitted freely and the drop of chi-squared is compared with
noise, with Bonferroni's correction for the number of positions. A reading up and a reading down
with the same tilt change the same sum, so from six positions alone it may be either of two: all
positions are listed that fit the readings nearly as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.accelerometers import Reference, StaticForce, equations
from inertial.estimation.probability import chi2_sf
from inertial.estimation.random_walk import MeasuredDrift
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.forward import Triad
from inertial.physics.motion import cross, level_axes

FREE_TILT_SIGMA = 0.02  # rad, of a tilt that is fitted freely: a degree
SIGNIFICANCE = 0.001  # accepted probability of a false alarm
MIN_DROP_DIFFERENCE = 6.0  # of chi-squared, from best to excluded: 95 % of 2 degrees of freedom


@dataclass(frozen=True)
class OffPosition:
    """A position that does not fit the others.

    `positions`: all candidates, the most likely first; `tilt`, `sigma`: rad, of that one; `about`:
    (3,), body axes, unit vector; `moved`: (12,), change of the parameters when it is fitted freely;
    `p_value`: after Bonferroni.
    """

    positions: tuple[str, ...]
    tilt: float
    sigma: float
    about: Array
    moved: Array
    p_value: float


def off_position(
    statics: Sequence[StaticForce],
    reference: Reference,
    about: Triad,
    effect_sigma: Mapping[str, float] | None,
    measured: MeasuredDrift,
) -> OffPosition | None:
    """The position in error, if there is one; `about`: M and bias of the estimate.

    `effect_sigma`: of parameters of effects as in `weighted`; they are fitted as well; `measured`:
    drift of the bias.
    """
    positions = list(dict.fromkeys(static.position for static in statics))
    setup = (reference, 0.0, about)
    columns = [f"{position}/{i}" for position in positions for i in (0, 1)]
    with_tilts, known = (
        _with_tilts(statics, reference.gravity, about.matrix),
        dict(effect_sigma or {}),
    )
    drift = (0.0, measured)
    information = equations(
        with_tilts, *setup, known | dict.fromkeys(columns, FREE_TILT_SIGMA), *drift
    ).effect_information()
    fitted = list(range(len(known)))
    base, _ = information.drop(fitted) if fitted else (0.0, 0)
    tilts = [[len(known) + 2 * i + k for k in (0, 1)] for i in range(len(positions))]
    drops = np.array([information.drop([*fitted, *pair])[0] - base for pair in tilts])
    best = int(np.argmax(drops))
    p_value = min(float(chi2_sf(drops[best], 2)) * len(positions), 1.0)
    if p_value >= SIGNIFICANCE:
        return None
    alike = [
        positions[i] for i in np.argsort(-drops) if drops[i] > drops[best] - MIN_DROP_DIFFERENCE
    ]
    own = columns[2 * best : 2 * best + 2]
    before = equations(statics, *setup, known, *drift).solve()
    freed = known | dict.fromkeys(own, FREE_TILT_SIGMA)
    after = equations(with_tilts, *setup, freed, *drift).solve()
    places = [after.names.index(("effect", name)) for name in own]
    up = next(static.up for static in statics if static.position == positions[best])
    horizontal = np.array(level_axes(up))
    vector = after.values[places] @ horizontal
    tilt = float(np.linalg.norm(vector))
    along = vector @ horizontal.T / tilt
    variance = along @ after.covariance[np.ix_(places, places)] @ along
    return OffPosition(
        tuple(alike),
        tilt,
        float(np.sqrt(variance)),
        vector / tilt,
        after.values[:UNKNOWNS] - before.values[:UNKNOWNS],
        p_value,
    )


def _with_tilts(statics: Sequence[StaticForce], gravity: float, matrix: Array) -> list[StaticForce]:
    """The static means with their sensitivities to the two tilts of their position."""
    result = []
    for static in statics:
        horizontal = np.array(level_axes(static.up))
        changes = cross(horizontal, gravity * static.up) @ matrix.T
        own = [f"{static.position}/{i}" for i in range(2)]
        result.append(replace(static, sensitivities=static.sensitivities.extended(own, changes.T)))
    return result
