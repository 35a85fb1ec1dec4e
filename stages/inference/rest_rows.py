"""The equations of the gyros at rest, and in a stretch of a turn at a known rate."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stages.inference.elimination import Name, Part
from stages.inference.level import all_turned
from stages.inference.random_walk import Stretch
from stages.inference.rests_and_turns import Earth, Position, Steady, Still
from stages.inference.triad import UNKNOWNS, design_of
from stages.model.motion import all_level_axes, level_axes, turned_all
from stages.model.vectors import cross

Array = NDArray[np.float64]


def level_names(position: Position) -> tuple[Name, ...]:
    """The unknown parts of the level earth rate of a position; none where north is known."""
    if position.north is not None:
        return ()
    name = "the table" if position.mark is not None else position.name
    return tuple((f"level {i}", name) for i in (0, 1))


def level_of(position: Position) -> Array:
    """The directions of the unknown parts of the level earth rate, (2, 3)."""
    if position.mark is not None:
        return np.array([position.mark, cross(position.up, position.mark)])
    return np.array(level_axes(position.up))


def of_rests(
    stills: Sequence[Still],
    matrix: Array,
    earth: Earth,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> list[tuple[str, Part, Stretch]]:
    """Position, equations and stretch of every rest.

    Parameters
    ----------
    matrix : M that the equations are linear about; `prior`: (s,), of the shared unknowns
    effects : names of the last shared unknowns
    sigma : of the errors, to which those of the rests are added
    """
    if not stills:
        return []
    n, s = len(stills), len(prior)
    positions = [still.position for still in stills]
    abouts = np.array([still.about for still in stills])
    angles = np.array([still.angle for still in stills])
    ups = all_turned(np.array([p.up for p in positions]), abouts, angles)
    norths = np.array([np.zeros(3) if p.north is None else p.north for p in positions])
    known = all_turned(earth.level * norths, abouts, angles)
    levels = all_level_axes(np.array([p.up for p in positions]))
    for i, position in enumerate(positions):
        if position.mark is not None:
            levels[i] = level_of(position)
    # The product M · earth is linear about the present M; the earth is small, so is the error.
    rows = np.zeros((n, 3, s + 3))
    for row in range(3):
        rows[:, row, 3 * row : 3 * row + 3] = known + earth.up * ups
        rows[:, row, 9 + row] = 1.0
    rows[:, :, UNKNOWNS] = ups @ matrix.T
    rows[:, :, UNKNOWNS + 1 : s] = [still.traces.of(effects) for still in stills]
    for i in (0, 1):
        rows[:, :, s + i] = all_turned(levels[:, i], abouts, angles) @ matrix.T
    rows[:, :, -1] = np.array([still.mean for still in stills]) + rows[:, :, UNKNOWNS] * earth.up
    rows[:, :, -1] -= rows[:, :, :s] @ prior
    noise = np.array([still.sigma for still in stills])
    found = []
    for i, still in enumerate(stills):
        names = level_names(still.position)
        sigma |= dict.fromkeys(names, earth.level / np.sqrt(2))
        columns = slice(None) if names else np.r_[:s, s + 2]
        part = whitened(rows[i][:, columns], noise[i], names)
        found.append((still.position.name, part, still.stretch or Stretch(f"rest {i}")))
    return found


def whitened(rows: Array, sigma: Array, own: tuple[Name, ...]) -> Part:
    """Equations in units of their sigma, without channels that are not recorded."""
    there = np.isfinite(rows[:, -1]) & np.isfinite(sigma)
    deviance = 2 * float(np.sum(np.log(sigma[there])))
    return Part(rows[there] / sigma[there, None], own, int(there.sum()), deviance)


def of_steady(
    steady: Steady,
    name: str,
    matrix: Array,
    earth: Earth,
    position_sigma: float,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> Part:
    """The equations of a stretch at a known rate; arguments as in `of_rests`."""
    names = level_names(steady.position)
    angles, shares = steady.rate * steady.elapsed, steady.seconds / steady.seconds.sum()
    known = np.zeros(3)
    if steady.position.north is not None:
        north = earth.level * steady.position.north
        known = shares @ turned_all(north, steady.about, angles)
    up = matrix @ steady.position.up
    truth = steady.rate * steady.about + known + earth.up * steady.position.up
    columns = [design_of(truth), up[:, None], steady.traces.of(effects)]
    sigma |= dict.fromkeys(names, earth.level / np.sqrt(2))
    if names:
        level = [shares @ turned_all(a, steady.about, angles) for a in level_of(steady.position)]
        columns.append(matrix @ np.column_stack(level))
    for i, axis in enumerate(level_axes(steady.about)):
        tilt = (f"tilt {i}", steady.position.name)
        sigma[tilt], names = position_sigma, (*names, tilt)
        columns.append((steady.rate * (matrix @ cross(axis, steady.about)))[:, None])
    rate = ("rate", name)
    sigma[rate], names = steady.rate_sigma, (*names, rate)
    columns.append((matrix @ steady.about)[:, None])
    design = np.hstack(columns)
    observed = steady.mean + up * earth.up - design[:, : len(prior)] @ prior
    return whitened(np.column_stack([design, observed]), steady.sigma, names)
