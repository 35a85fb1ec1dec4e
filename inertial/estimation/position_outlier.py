"""Whether one set position is off by more than the table's sigma, and what that spoils.

The tilts of each position in turn are left free and the drop of chi-squared is held against noise,
the search over all positions paid for. A reading up and a reading down that are tilted alike change
the same sum, so from six positions alone it may be either of two: all are named that explain the
readings nearly as well.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.accelerometers import StaticForce, equations
from inertial.estimation.probability import chi2_sf
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.motion import all_level_axes
from inertial.physics.vectors import cross

Array = NDArray[np.float64]

FREE = 0.02  # rad, sigma of a tilt that is left free: a degree
LEVEL = 0.001  # accepted chance of finding a position off where none is
ALIKE = 6.0  # drop of chi-squared by which the best must exceed another: 95 % of 2 degrees


@dataclass(frozen=True)
class OffPosition:
    """A position that does not fit the others.

    `positions`: all that may be the one, the likeliest first; `tilt`, `sigma`: rad, how far that
    one is off; `about`: (3,), body axes, unit vector; `moved`, `freed_sigma`: (12,), by how much
    the parameters change when it is left free, and their sigmas then; `p_value`: after the search.
    """

    positions: tuple[str, ...]
    tilt: float
    sigma: float
    about: Array
    moved: Array
    freed_sigma: Array
    p_value: float


def off_position(
    rests: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    matrix: Array,
    wide: Mapping[str, float] | None = None,
) -> OffPosition | None:
    """The position that is off, if there is one; `matrix`: M of the estimate, (3, 3).

    `wide`: sigmas of further unknowns, as in `weighted`; they are fitted as well.
    """
    positions = list(dict.fromkeys(rest.position for rest in rests))
    given = (gravity, gravity_sigma, position_sigma, 0.0, matrix)
    columns = [f"{position}/{i}" for position in positions for i in (0, 1)]
    traced, known = _traced(rests, gravity, matrix), dict(wide or {})
    reduced = equations(traced, *given, known | dict.fromkeys(columns, FREE)).effect_information()
    further = list(range(len(known)))
    base, _ = reduced.drop(further) if further else (0.0, 0)
    tilts = [[len(known) + 2 * i + k for k in (0, 1)] for i in range(len(positions))]
    drops = np.array([reduced.drop([*further, *pair])[0] - base for pair in tilts])
    best = int(np.argmax(drops))
    p_value = min(float(chi2_sf(drops[best], 2)) * len(positions), 1.0)
    if p_value >= LEVEL:
        return None
    alike = [positions[i] for i in np.argsort(-drops) if drops[i] > drops[best] - ALIKE]
    own = columns[2 * best : 2 * best + 2]
    before = equations(rests, *given, known).solve()
    after = equations(traced, *given, known | dict.fromkeys(own, FREE)).solve()
    places = [after.names.index(("effect", name)) for name in own]
    level = all_level_axes(next(r.up for r in rests if r.position == positions[best])[None])[0]
    vector = after.values[places] @ level
    tilt = float(np.linalg.norm(vector))
    along = vector @ level.T / tilt
    variance = along @ after.covariance[np.ix_(places, places)] @ along
    return OffPosition(
        tuple(alike),
        tilt,
        float(np.sqrt(variance)),
        vector / tilt,
        after.values[:UNKNOWNS] - before.values[:UNKNOWNS],
        after.sigma[:UNKNOWNS],
        p_value,
    )


def _traced(rests: Sequence[StaticForce], gravity: float, matrix: Array) -> list[StaticForce]:
    """The rests with what the two tilts of their position do to them."""
    found = []
    for rest in rests:
        level = all_level_axes(rest.up[None])[0]
        leans = cross(level, gravity * rest.up) @ matrix.T
        own = [f"{rest.position}/{i}" for i in range(2)]
        found.append(replace(rest, sensitivities=rest.sensitivities.extended(own, leans.T)))
    return found
