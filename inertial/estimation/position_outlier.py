"""Test of one set position for an error larger than the table's sigma, and its consequences.

The tilts of each position in turn are fitted freely and the drop of chi-squared is compared with
noise, with Bonferroni's correction for the number of positions. A reading up and a reading down
with the same tilt change the same sum, so from six positions alone it may be either of two: all
positions are listed that fit the readings nearly as well.

A position that is off by degrees is no error to be linear in, and what it does resembles many an
effect. Its attitude is taken as unknown where that explains most of what the others leave.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.accelerometers import Reference, StaticForce, equations, weighted
from inertial.estimation.elimination import TILTS
from inertial.estimation.least_squares import Estimate
from inertial.estimation.probability import chi2_sf
from inertial.estimation.random_walk import MeasuredDrift
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.forward import Triad
from inertial.physics.motion import cross, level_axes

FREE_TILT_SIGMA = 0.02  # rad, of a tilt that is fitted freely: a degree
SIGNIFICANCE = 0.001  # accepted probability of a false alarm
MIN_OFF = np.sqrt(2e-5)  # rad: from there 1 − cos, which no linear error has, is above 10 µg
MIN_OFF_SIGMAS = 20.0  # of the table: less is an error that it makes
MIN_BEYOND = MIN_OFF_SIGMAS**2 / 4  # of chi-squared: so much is left even of half of such an error
MAX_OFF = np.radians(15.0)  # more is another position
MAX_OFF_POSITIONS = 3
MAX_REST = 1 / 3  # of what is beyond noise: else the positions are not what is wrong
MIN_CLEAR = 20.0  # of chi-squared, to the next position that it may be
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


def is_off(tilt: float, position_sigma: float) -> bool:
    """Whether a position is off by degrees, and by far more than the table's sigma, rad."""
    return bool(tilt > max(MIN_OFF, MIN_OFF_SIGMAS * position_sigma))


@dataclass(frozen=True)
class FarOff:
    """A position off by degrees: its tilt in body axes, (3,), rad, and the sigma of its size."""

    position: str
    tilt: Array
    sigma: float


def far_off(
    statics: Sequence[StaticForce],
    reference: Reference,
    effect_sigma: Mapping[str, float] | None,
    measured: MeasuredDrift,
) -> list[FarOff]:
    """The positions that are off by degrees, where these are what is wrong; else none.

    Arguments as in `weighted`.
    """
    ups = {static.position: static.up for static in statics}

    def freed(free: frozenset[str]) -> Estimate:
        own = reference._replace(free=free)
        return weighted(statics, own, effect_sigma=effect_sigma, measured=measured)

    fitted = first = freed(frozenset())
    found: list[str] = []
    while len(found) < MAX_OFF_POSITIONS and _beyond(fitted) > MIN_BEYOND:
        tried = {one: freed(frozenset({*found, one})) for one in ups if one not in found}
        ranked = sorted(tried, key=lambda one: tried[one].chi_squared)
        least, *others = (tried[one].chi_squared for one in ranked)
        own = _tilt_of(tried[ranked[0]], ranked[0], ups[ranked[0]])
        size = float(np.linalg.norm(own.tilt))
        clear = size > MIN_OFF_SIGMAS * own.sigma and not (others and others[0] < least + MIN_CLEAR)
        if not (clear and is_off(size, reference.position_sigma) and size < MAX_OFF):
            break
        found.append(ranked[0])
        fitted = tried[ranked[0]]
    if not found or _beyond(fitted) > MAX_REST * _beyond(first):
        return []
    return [_tilt_of(fitted, one, ups[one]) for one in found]


def _beyond(fitted: Estimate) -> float:
    """Chi-squared beyond its degrees of freedom."""
    return max(fitted.chi_squared - fitted.degrees, 0.0)


def _tilt_of(fitted: Estimate, position: str, up: Array) -> FarOff:
    places = [fitted.names.index((kind, position)) for kind in TILTS]
    values, sigmas = fitted.values[places], fitted.sigma[places]
    across = float(np.abs(values) @ sigmas / np.linalg.norm(values))
    return FarOff(position, values @ np.array(level_axes(up)), across)


def _with_tilts(statics: Sequence[StaticForce], gravity: float, matrix: Array) -> list[StaticForce]:
    """The static means with their sensitivities to the two tilts of their position."""
    result = []
    for static in statics:
        horizontal = np.array(level_axes(static.up))
        changes = cross(horizontal, gravity * static.up) @ matrix.T
        own = [f"{static.position}/{i}" for i in range(2)]
        result.append(replace(static, sensitivities=static.sensitivities.extended(own, changes.T)))
    return result
