"""The earth's rate on the table: mean over a stretch, and azimuth of its horizontal component."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import EquationBlock, Name
from inertial.estimation.gyroscope_rows import Around, Earth, Position
from inertial.physics.motion import level_axes, turned_all
from inertial.physics.vectors import cross

# ---- What an unknown azimuth leaves known: the size of the level earth rate.
#
# Of a position without a known north the level rate has two unknown parts, but their size is that
# of the site: (level 0, level 1) = ω_e cos φ (cos a, sin a), with the azimuth a alone unknown.
# About an azimuth a₀ that is
#
#     cos a₀ · level 0 + sin a₀ · level 1 = ω_e cos φ
#
# and nothing of the part across. What is left out grows with (a − a₀)²/2, so it is said only
# where the data tell the azimuth well, and a₀ is that of the last result; else the parts are
# those of any direction, each with the size as its sigma.

Array = NDArray[np.float64]

KNOWN = 0.2  # rad: with this sigma, what is left out is a tenth of the sigma of the size
EXACT = 1e-4  # relative: to what the size is said
SAID = 1e-3  # relative: how near the size of the parts comes to it then
VAGUE = 1e3  # times the size: sigma of the parts where the size is said of them


def known_azimuths(sigmas: Mapping[Name, float], earth: Earth) -> frozenset[str]:
    """The positions whose azimuth the data tell well, by the sigmas of all unknowns."""
    names = {name for kind, name in sigmas if kind.startswith("level")}
    worst = {name: max(sigmas[f"level {i}", name] for i in (0, 1)) for name in names}
    return frozenset(name for name, sigma in worst.items() if sigma < KNOWN * earth.level)


def said_of(levels: Mapping[Name, float], size: float) -> frozenset[str]:
    """The positions of which a result says the size already: their parts have it."""
    names = {name for kind, name in levels if kind == "level 0" and ("level 1", name) in levels}
    found = {name: np.hypot(levels["level 0", name], levels["level 1", name]) for name in names}
    return frozenset(name for name, length in found.items() if abs(length / size - 1) < SAID)


def sized(
    around: Around, earth: Earth, shared: int, sigma: dict[Name, float]
) -> Callable[[EquationBlock], EquationBlock]:
    """Adds the size of the level rate to the first part that sees it, for each known azimuth.

    `shared`: the number of shared unknowns; `sigma`: of the errors, where the parts become vague.
    """
    left = {
        name
        for name in around.azimuths
        if ("level 0", name) in sigma and ("level 0", name) in around.levels
    }
    for name in left:
        sigma |= dict.fromkeys((("level 0", name), ("level 1", name)), VAGUE * earth.level)

    def told(part: EquationBlock) -> EquationBlock:
        names = {name for kind, name in part.own if kind == "level 0"} & left
        for name in names:
            left.remove(name)
            parts = [("level 0", name), ("level 1", name)]
            level = np.array([around.levels[one] for one in parts])
            row = np.zeros((1, part.rows.shape[1]))
            columns = [shared + part.own.index(one) for one in parts]
            row[0, columns] = level / np.linalg.norm(level)
            row[0, -1] = earth.level
            rows = np.vstack([part.rows, row / (EXACT * earth.level)])
            # The azimuth is fitted, so there is one degree of freedom less.
            part = EquationBlock(rows, part.own, part.count - 1, part.deviance)
        return part

    return told


# ---- What a stretch on the table sees of the turning earth.
#
# The upward part stays where it is while the table turns about the vertical; the level part turns
# in body axes, and its sum over a whole turn at a steady rate is zero. Ramps and standstill leave
# some of it: of S3's windows of 64 s and 36 s, 4.0 s and 6.0 s times the level rate, which is
# 0.81 and 2.16 °/h of their means.


@dataclass(frozen=True)
class EarthSeen:
    """The earth's rate in body axes, summed over a stretch; all (3,).

    `known`: what is known of it, rad; `up`: per unit of the upward rate, s; `level`: for each
    unknown direction of the level rate, by kind and name, its size at one sigma, rad.
    """

    known: Array
    up: Array
    level: Mapping[tuple[str, str], Array]


def earth_seen(
    earth: Earth, position: Position, about: Array, angles: Array, seconds: Array
) -> EarthSeen:
    """Sum the earth's rate over pieces of a turn.

    An unknown azimuth is a random direction of the level rate; positions with a common mark
    share it.

    Parameters
    ----------
    about : (3,), axis of the turn, body axes at its start
    angles : (k,), rad, turned since the start at the middle of each piece
    seconds : (k,), how long each piece is; shares of 1 give the mean rate, in rad/s, instead
    """

    def summed(direction: Array) -> Array:
        return np.asarray(seconds @ turned_all(direction, about, angles))

    up = summed(position.up)
    if position.north is not None:
        return EarthSeen(earth.up * up + earth.level * summed(position.north), up, {})
    axes, name = level_axes(position.up), position.name
    if position.mark is not None:
        axes, name = (position.mark, cross(position.up, position.mark)), "the table"
    sigma = earth.level / np.sqrt(2)
    level = {(f"level {i}", name): sigma * summed(axis) for i, axis in enumerate(axes)}
    return EarthSeen(earth.up * up, up, level)
