"""The gyros by S3's own formulas: turns forward and backward, and the stops between them.

    sum over a turn  N± = M (±2π u + E T) + D T
    N⁺ − N⁻ = 2 · 2π · M u          (S3 13, 14; 2π, not the set rate times the window)
    N⁺ + N⁻ = 2 T (D + M E)         (S3 15)
    mean at rest = D + M E

u: axis of the turn, in body axes; D: bias; E: the earth's rate. S3 says that over a turn the earth
rate integrates to zero. That is so of its level part at a steady rate; ramps and standstill leave
some of it, the same in both directions. So the difference is exact, and the sum keeps 0.81 °/h
(64 s at 6 °/s) and 2.16 °/h (36 s at 12 °/s) on the level gyros, in a direction that is known only
with the azimuth. The upward part, 7.64 °/h, stays in the sum too; it is taken out, and turns
with the axis up and turns with the axis down cancel what is wrong with it, once each sum is divided
by its own T: undivided sums of 64 s and 36 s would keep 2.14 °/h.

Where forward and backward differ in angle or duration, the two equations are solved as they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.accelerometer_formulas import pooling
from inertial.estimation.gyroscope_formulas import Readings, Solution
from inertial.estimation.gyroscope_observations import Earth, RateSegment, StaticRate
from inertial.estimation.horizontal_earth_rate import SummedEarthRate, summed_earth_rate
from inertial.estimation.least_squares import pseudo_inverse
from inertial.physics.motion import level_axes, turned
from inertial.physics.vectors import cross

Array = NDArray[np.float64]

UNKNOWN = 0.01  # of an element of M that no turn shows: a mounting askew by half a degree


@dataclass(frozen=True)
class BothTurns:
    """What a turn forward and a turn backward give: M u, 1, and D + M E, rad/s, (3,) each."""

    along: Array
    offset: Array


def both_turns(forward: RateSegment, backward: RateSegment) -> BothTurns:
    """S3 (13) to (15) for one axis; both turns are about it, their angles of opposite sign."""
    of_along, of_offset = _factors(forward, backward)
    sums = np.array([forward.sums.sum(axis=0), backward.sums.sum(axis=0)])
    return BothTurns(of_along @ sums, of_offset @ sums)


def _factors(forward: RateSegment, backward: RateSegment) -> tuple[Array, Array]:
    """How the two sums make M u, and how they make D + M E, (2,) each; 1/rad and 1/s."""
    seconds = np.array([forward.seconds.sum(), backward.seconds.sum()])
    angle = np.array([forward.angle, backward.angle])
    determinant = angle[0] * seconds[1] - angle[1] * seconds[0]
    of_along = np.array([seconds[1], -seconds[0]]) / determinant
    of_offset = np.array([-angle[1], angle[0]]) / determinant
    return of_along, of_offset


def pairs_of(turns: Sequence[RateSegment]) -> list[tuple[int, int]]:
    """Turns forward, each with one backward of the same axis and attitude: their numbers.

    A turn of which something is missing is none of them.
    """
    turns = [_upward(turn) for turn in turns]
    found: list[tuple[int, int]] = []
    whole = [j for j, turn in enumerate(turns) if not turn.gaps]
    backward = [j for j in whole if turns[j].angle < 0]
    for i in whole:
        alike = [j for j in backward if turns[i].angle > 0 and _alike(turns[i], turns[j])]
        if alike:
            backward.remove(alike[0])
            found.append((i, alike[0]))
    return found


def _upward(turn: RateSegment) -> RateSegment:
    """The same turn told about the end of its axis that points up."""
    if turn.about @ turn.position.up >= 0:
        return turn
    return replace(turn, about=-turn.about, angle=-turn.angle)


def _alike(one: RateSegment, other: RateSegment) -> bool:
    """Whether two turns are about the same axis from the same attitude."""
    same = np.allclose(one.about, other.about, atol=1e-9)
    return same and np.allclose(one.position.up, other.position.up, atol=1e-9)


@dataclass(frozen=True)
class TurnAndStop:
    """M with the bias by turns and with the bias by rests, and the turns that are used.

    `by_turns`, `by_rests`: None where there are no such. Both have the same M.
    """

    by_turns: Solution | None
    by_rests: Solution | None
    pairs: list[tuple[int, int]]


def turn_and_stop(
    turns: Sequence[RateSegment],
    stills: Sequence[StaticRate],
    earth: Earth,
    position_sigma: float,
    scatter: float = 0.0,
) -> TurnAndStop:
    """S3's formulas with the covariance that they have.

    All orientations count alike, and of the rests at one attitude the mean is taken first: S3's
    stops by the forward and the backward turn are one position. A column of M whose axis nobody
    turned about both ways is not determined; where the earth is taken out it counts as known to
    0.01. Sigmas are of white noise, the angle of each turn, the tilt of each position (rad), the
    earth's rate, an unknown azimuth, and the `scatter` between manoeuvres (rad/s).
    """
    pairs = pairs_of(turns)
    turns = [_upward(turns[i]) for pair in pairs for i in pair]
    n = len(turns) + len(stills)
    of_along, of_offset = np.zeros((len(pairs), n)), np.zeros((len(pairs), n))
    for row in range(len(pairs)):
        both = slice(2 * row, 2 * row + 2)
        of_along[row, both], of_offset[row, both] = _factors(*turns[both])
    span = pseudo_inverse(np.array([turn.about for turn in turns[::2]]).reshape(-1, 3))
    of_matrix = span.inverse @ of_along  # (3, n)

    sums = [turn.sums.sum(axis=0) for turn in turns] + [still.mean for still in stills]
    values = np.array(sums).reshape(-1, 3)
    recorded = np.isfinite(values).all(axis=0)
    columns = recorded[:, None] & span.determined[None, :]  # (gyro, axis)
    seen = _earth(turns, stills, earth)
    matrix, left = np.eye(3), values
    for _ in range(3):  # the earth is read through M, which is not known before
        left = values - np.array([one.known for one in seen]).reshape(-1, 3) @ matrix.T
        matrix = np.where(columns, (of_matrix @ np.nan_to_num(left)).T, np.eye(3))

    sway = np.array([scatter * turn.seconds.sum() for turn in turns] + [scatter] * len(stills))
    noise = [turn.quiet_density * np.sqrt(turn.seconds.sum()) for turn in turns]
    noise += [still.sigma for still in stills]
    readings = Readings(left, np.hypot(np.array(noise).reshape(-1, 3), sway[:, None]))
    for j, one in enumerate(seen):
        readings.suffer("earth", "up", j, matrix @ one.up * earth.up_sigma)
        for (kind, name), size in one.level.items():
            readings.suffer(kind, name, j, matrix @ size)
        for gyro, axis in np.argwhere(~columns):
            unseen = UNKNOWN * one.known[axis] * np.eye(3)[gyro]
            readings.suffer("unknown", f"{gyro} {axis}", j, unseen)
    for j, turn in enumerate(turns):
        readings.suffer("angle", str(j), j, matrix @ turn.about * turn.angle_sigma)
        for i, level in enumerate(level_axes(turn.about)):
            lean = turn.angle * cross(level, turn.about) * position_sigma
            readings.suffer(f"tilt {i}", turn.position.name, j, matrix @ lean)

    def solution(of_bias: Array) -> Solution:
        """M, and the bias as a mean of readings that hold D + M E."""
        weights = np.broadcast_to(np.vstack([of_matrix, of_bias]), (3, 4, n))
        return readings.solution(weights, np.column_stack([columns, recorded]))

    by_rests = None
    if stills:
        ups = np.array([turned(s.position.up, s.about, s.angle) for s in stills])
        by_rests = solution(np.append(np.zeros(len(turns)), pooling(ups)[1].mean(axis=0)))
    return TurnAndStop(solution(of_offset.mean(axis=0)) if pairs else None, by_rests, pairs)


def _earth(
    turns: Sequence[RateSegment], stills: Sequence[StaticRate], earth: Earth
) -> list[SummedEarthRate]:
    """The earth in every sum, rad, and in every mean, rad/s."""
    moving = [(t.position, t.about, _angles(t), t.seconds) for t in turns]
    at_rest = [(s.position, s.about, np.array([s.angle]), np.ones(1)) for s in stills]
    return [summed_earth_rate(earth, *one) for one in moving + at_rest]


def _angles(turn: RateSegment) -> Array:
    """The angle at the middle of each block, by the gyros along the axis.

    What they exceed the known angle by is bias and earth, alike in all of the turn.
    """
    along = np.nan_to_num(turn.sums) @ turn.about
    if abs(along.sum()) < abs(turn.angle) / 2:  # no gyro along the axis was recorded
        along = np.zeros(len(turn.seconds))
    own = along + (turn.angle - along.sum()) * turn.seconds / turn.seconds.sum()
    return np.asarray(np.cumsum(own) - own / 2)
