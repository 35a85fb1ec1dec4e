"""How the table moved: in every rest, in the blocks of a turn, and sample by sample."""

import numpy as np
from numpy.typing import NDArray

from stages.contracts.records import Manoeuvre
from stages.estimation.solution import Solution
from stages.estimation.stills import Still
from stages.estimation.turns import position_of
from stages.inference.whole_turns import Turn
from stages.model.forward import Site, Triad
from stages.model.motion import Motion, Profile, turned, turned_all

Array = NDArray[np.float64]


def at_rest(still: Still, solution: Solution, heading: float | None, time: float) -> Motion:
    """A rest as one stretch of time, about its middle `time`, s."""
    m = still.manoeuvre
    up = turned(solution.upright(m), still.about, still.angle)
    north = turned(solution.north(position_of(m, heading)), still.about, still.angle)
    zero = np.zeros(1)
    angle = np.array([still.angle])
    return Motion(np.array([time]), still.about, angle, zero, zero, up[None], north[None])


def in_blocks(
    m: Manoeuvre, turn: Turn, solution: Solution, heading: float | None, time: Array
) -> Motion:
    """A turn in the k blocks of its sums; the angle of each is what the gyros saw of it."""
    up, north = solution.upright(m), solution.north(position_of(m, heading))
    gyro, site = solution.gyro, solution.site
    assert gyro is not None  # else nothing is simulated
    angle = angles_seen(turn.sums, turn.seconds, m.axis, up, north, gyro, site)
    rate = angle / turn.seconds
    ends = np.cumsum(turn.seconds)
    middle = np.cumsum(angle) - angle / 2
    return Motion(
        time,
        m.axis,
        middle,
        rate,
        np.gradient(rate, ends - turn.seconds / 2),
        turned_all(up, m.axis, middle),
        turned_all(north, m.axis, middle),
    )


def angles_seen(
    sums: Array, seconds: Array, about: Array, up: Array, north: Array, gyro: Triad, site: Site
) -> Array:
    """The angle that the table turned in each stretch, by the gyros, (k,), rad.

    The earth's rate is taken out in the direction that the angle so far gives it.
    """
    inverse = np.linalg.inv(gyro.matrix)
    truth = (sums - np.outer(seconds, gyro.bias)) @ inverse.T
    level = site.earth_level * np.nan_to_num(north)
    angle = truth @ about
    for _ in range(2):
        middle = np.cumsum(angle) - angle / 2
        earth = site.earth_up * turned_all(up, about, middle) + turned_all(level, about, middle)
        angle = truth @ about - earth @ about * seconds
    return np.asarray(angle)


def in_samples(
    m: Manoeuvre,
    increments: Array,
    step: float,
    steady: NDArray[np.bool_],
    time: Array,
    solution: Solution,
    heading: float | None,
) -> tuple[Motion, str]:
    """A whole turn sample by sample, and how its profile was had.

    A table with a stated rate and acceleration turns by a trapezoid of the rate, whose
    middle in time is taken from the steady part of the gyros' angle. Else the angle is that
    of the gyros, made the stated one as a whole.

    Parameters
    ----------
    increments : (n, 3), rad, of the gyros; `step`, s, of each
    steady : (n,), which samples are at the steady rate
    """
    up, north = solution.upright(m), solution.north(position_of(m, heading))
    assert solution.gyro is not None and m.angle is not None  # else it is not simulated
    seconds = np.full(len(increments), step)
    seen = angles_seen(increments, seconds, m.axis, up, north, solution.gyro, solution.site)
    ends = step * np.arange(1, len(seen) + 1)
    if m.rate is not None and m.acceleration is not None and steady.any():
        after = np.cumsum(seen)
        middle = float(np.mean(ends[steady] - (after[steady] - m.angle / 2) / m.rate))
        profile = Profile(abs(m.angle), abs(m.rate), m.acceleration)
        edges = np.append(0.0, ends) - (middle - profile.seconds / 2)
        angles, rates = profile.at(edges)
        sign = np.sign(m.angle)
        angles, rates, how = sign * angles, sign * rates, "trapezoid"
    else:
        angles = np.append(0.0, np.cumsum(seen)) * (m.angle / float(seen.sum()))
        rates = np.gradient(angles, step)
        how = "as the gyros have it"
    halfway = (angles[1:] + angles[:-1]) / 2
    motion = Motion(
        time,
        m.axis,
        halfway,
        np.diff(angles) / step,
        np.diff(rates) / step,
        turned_all(up, m.axis, halfway),
        turned_all(north, m.axis, halfway),
    )
    return motion, how
