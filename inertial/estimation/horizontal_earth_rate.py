"""The earth's rate on the table: mean over a stretch, and azimuth of its horizontal component."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.estimation.elimination import EquationBlock, Name
from inertial.estimation.gyroscope_equations import (
    Linearisation,
    horizontal_axes,
    horizontal_names,
    horizontal_sigma,
)
from inertial.estimation.gyroscope_observations import EARTH_UP, Earth, Position
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.motion import turned_all

# ---- The known size of the horizontal earth rate as a constraint.
#
# Of a position without a known north the horizontal rate has two unknown components, but its size
# is that of the site: (level 0, level 1) = ω_e cos φ (cos a, sin a), with the azimuth a alone
# unknown. About an azimuth a₀ that is
#
#     cos a₀ · level 0 + sin a₀ · level 1 = ω_e cos φ = √(ω_e² − up²)
#
# without any equation for the component across. Without a latitude `up`, ω_e sin φ, is as unknown,
# and the right side is linear about its last value. The neglected term grows with (a − a₀)²/2, so
# the constraint is applied only where the data determine the azimuth well, and a₀ is that of the
# last result; else the components are those of a random direction, each with the size as its sigma.
# Effects that change the size, as a wrong latitude, stand on the right side as well.

MAX_AZIMUTH_SIGMA = 0.2  # rad: the neglected term is then a tenth of the sigma of the size
CONSTRAINT_SIGMA = 1e-4  # relative, of the size
CONSTRAINED_TOLERANCE = 1e-3  # relative: how well a constrained result has the size
VAGUE_SIGMA = 1e3  # in units of the size: of both components where the size is constrained


def known_azimuths(sigmas: Mapping[Name, float], earth: Earth) -> frozenset[str]:
    """The positions whose azimuth the data determine well, by the sigmas of all unknowns."""
    names = {name for kind, name in sigmas if kind.startswith("level")}
    largest = {name: max(sigmas[f"level {i}", name] for i in (0, 1)) for name in names}
    limit = MAX_AZIMUTH_SIGMA * earth.level
    return frozenset(name for name, sigma in largest.items() if sigma < limit)


def constrained_positions(levels: Mapping[Name, float], size: float) -> frozenset[str]:
    """The positions whose horizontal rate was constrained in a result: it has this size."""
    names = {name for kind, name in levels if kind == "level 0" and ("level 1", name) in levels}
    sizes = {name: np.hypot(levels["level 0", name], levels["level 1", name]) for name in names}
    return frozenset(
        name for name, own in sizes.items() if abs(own / size - 1) < CONSTRAINED_TOLERANCE
    )


def size_constraint(
    point: Linearisation, earth: Earth, changes: Sequence[float], sigma: dict[Name, float]
) -> Callable[[EquationBlock], EquationBlock]:
    """Adds the constraint to the first block with the components, for each known azimuth.

    `changes`: of the size per unit of the parameters of effects, the last of the shared unknowns;
    `sigma`: of the errors, where the components become vague.
    """
    shared = UNKNOWNS + 1 + len(changes)
    pending = {
        name
        for name in point.azimuths
        if ("level 0", name) in sigma and ("level 0", name) in point.levels
    }
    up = point.levels.get(EARTH_UP, earth.up)
    size = earth.level_beside(up)
    pending = pending if size else set()
    for name in pending:
        sigma |= dict.fromkeys((("level 0", name), ("level 1", name)), VAGUE_SIGMA * earth.level)

    def constrained(block: EquationBlock) -> EquationBlock:
        names = {name for kind, name in block.own if kind == "level 0"} & pending
        for name in names:
            pending.remove(name)
            keys = [("level 0", name), ("level 1", name)]
            level = np.array([point.levels[key] for key in keys])
            row = np.zeros((1, block.rows.shape[1]))
            row[0, [shared + block.own.index(key) for key in keys]] = level / np.linalg.norm(level)
            row[0, UNKNOWNS] = up / size
            row[0, UNKNOWNS + 1 : shared] = -np.asarray(changes)
            row[0, -1] = size + up / size * (up - earth.up)
            rows = np.vstack([block.rows, row / (CONSTRAINT_SIGMA * size)])
            # The azimuth is fitted, so there is one degree of freedom less.
            block = EquationBlock(rows, block.own, block.count - 1, block.deviance)
        return block

    return constrained


# ---- The earth's rate summed over a stretch on the table.
#
# The upward component stays constant while the table turns about the vertical; the horizontal
# component turns in body axes, and its sum over a whole turn at a steady rate is zero. Ramps and
# standstill leave a remainder: of S3's windows of 64 s and 36 s, 4.0 s and 6.0 s times the
# horizontal rate, which is 0.81 and 2.16 °/h of their means.


@dataclass(frozen=True)
class SummedEarthRate:
    """The earth's rate in body axes, summed over a stretch; all (3,).

    `known`: its known part, rad; `up`: per unit of the upward rate, s; `level`: for each
    unknown component of the horizontal rate, by kind and name, its size at one sigma, rad.
    """

    known: Array
    up: Array
    level: Mapping[Name, Array]


def summed_earth_rate(
    earth: Earth, position: Position, about: Array, angles: Array, seconds: Array
) -> SummedEarthRate:
    """Sum the earth's rate over pieces of a turn.

    An unknown azimuth is a random direction of the horizontal rate; positions with a common mark
    share it.

    Parameters
    ----------
    about : (3,), axis of the turn, body axes at its start
    angles : (k,), rad, turned since the start at the middle of each piece
    seconds : (k,), duration of each piece; shares of 1 give the mean rate, in rad/s, instead
    """

    def summed(direction: Array) -> Array:
        return np.asarray(seconds @ turned_all(direction, about, angles))

    up = summed(position.up)
    if position.north is not None:
        return SummedEarthRate(earth.up * up + earth.level * summed(position.north), up, {})
    sigma = horizontal_sigma(position, earth)
    axes = zip(horizontal_names(position), horizontal_axes(position), strict=True)
    return SummedEarthRate(earth.up * up, up, {key: sigma * summed(axis) for key, axis in axes})
