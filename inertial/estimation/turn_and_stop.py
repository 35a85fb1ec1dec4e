"""The gyros by S3's own formulas: turns forward and backward, and the stops between them.

    sum over a turn  N± = M (±2π u + E T) + D T
    N⁺ − N⁻ = 2 · 2π · M u          (S3 13, 14; 2π, not the set rate times the window)
    N⁺ + N⁻ = 2 T (D + M E)         (S3 15)
    mean at rest = D + M E

u: axis of the turn, in body axes; D: bias; E: the earth's rate. S3 states that over a turn the
earth rate integrates to zero. That holds for its horizontal component at a steady rate; ramps and
standstill leave a remainder, the same in both directions. So the difference is exact, and the sum
keeps 0.81 °/h (64 s at 6 °/s) and 2.16 °/h (36 s at 12 °/s) on the horizontal gyros, in a direction
that is known only with the azimuth. The upward component, 7.64 °/h, stays in the sum too; it is
subtracted, and turns with the axis up and turns with the axis down cancel its error, once each sum
is divided by its own T: undivided sums of 64 s and 36 s would keep 2.14 °/h.

Where forward and backward differ in angle or duration, the two equations are solved as they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.estimation.accelerometer_formulas import pooling
from inertial.estimation.gyroscope_equations import CLOCK
from inertial.estimation.gyroscope_formulas import Readings, Solution, paired
from inertial.estimation.gyroscope_observations import Earth, RateSegment, StaticRate
from inertial.estimation.horizontal_earth_rate import SummedEarthRate, summed_earth_rate
from inertial.estimation.least_squares import pseudo_inverse
from inertial.physics.motion import turned

CROSS_SIGMA = 0.01  # of an element of M that no turn determines: mounting within half a degree
EARTH_ITERATIONS = 3  # the earth's rate is sensed through M, which is an unknown


def _factors(forward: RateSegment, backward: RateSegment) -> tuple[Array, Array]:
    """S3 (13) to (15): coefficients of the two sums in M u and in D + M E, (2,) each; 1/rad, 1/s.

    Both turns are about one axis, their angles of opposite sign.
    """
    seconds = np.array([forward.seconds.sum(), backward.seconds.sum()])
    angle = np.array([forward.angle, backward.angle])
    determinant = angle[0] * seconds[1] - angle[1] * seconds[0]
    along_factors = np.array([seconds[1], -seconds[0]]) / determinant
    offset_factors = np.array([-angle[1], angle[0]]) / determinant
    return along_factors, offset_factors


def pairs_of(turns: Sequence[RateSegment]) -> list[tuple[int, int]]:
    """Turns forward, each with one backward of the same axis and attitude: their numbers.

    Turns with gaps are not used.
    """
    turns = [_upward(turn) for turn in turns]
    whole = [j for j, turn in enumerate(turns) if not turn.gaps]
    forward, backward = ([j for j in whole if turns[j].angle * sign > 0] for sign in (1, -1))
    return paired(forward, backward, lambda i, j: _alike(turns[i], turns[j]))


def _upward(turn: RateSegment) -> RateSegment:
    """The same turn about the end of its axis that points up."""
    if turn.about @ turn.position.up >= 0:
        return turn
    return replace(turn, about=-turn.about, angle=-turn.angle)


def _alike(one: RateSegment, other: RateSegment) -> bool:
    """Whether two turns are about the same axis from the same attitude."""
    same = np.allclose(one.about, other.about, atol=1e-9)
    return same and np.allclose(one.position.up, other.position.up, atol=1e-9)


@dataclass(frozen=True)
class TurnAndStop:
    """M with the bias by turns and with the bias by rests, and the turns used.

    `by_turns`, `by_rests`: None without such. Both have the same M.
    """

    by_turns: Solution | None
    by_rests: Solution | None
    pairs: list[tuple[int, int]]


def turn_and_stop(
    turns: Sequence[RateSegment],
    statics: Sequence[StaticRate],
    earth: Earth,
    position_sigma: float,
    scatter: float = 0.0,
) -> TurnAndStop:
    """S3's formulas with their covariance.

    All orientations have the same weight, and of the rests at one attitude the mean is taken first:
    S3's stops by the forward and the backward turn are one position. A column of M whose axis was
    not turned about both ways is not determined; where the earth's rate is subtracted it counts as
    known to `CROSS_SIGMA`. Sigmas are of white noise, the angle of each turn, the tilt of each
    position (rad), the earth's rate, an unknown azimuth, and the `scatter` between manoeuvres
    (rad/s).
    """
    pairs = pairs_of(turns)
    turns = [_upward(turns[i]) for pair in pairs for i in pair]
    n = len(turns) + len(statics)
    along_factors, offset_factors = np.zeros((len(pairs), n)), np.zeros((len(pairs), n))
    for row in range(len(pairs)):
        both = slice(2 * row, 2 * row + 2)
        along_factors[row, both], offset_factors[row, both] = _factors(*turns[both])
    inverse = pseudo_inverse(np.array([turn.about for turn in turns[::2]]).reshape(-1, 3))
    matrix_factors = inverse.inverse @ along_factors  # (3, n)

    sums = [turn.sums.sum(axis=0) for turn in turns] + [static.mean for static in statics]
    values = np.array(sums).reshape(-1, 3)
    recorded = np.isfinite(values).all(axis=0)
    columns = recorded[:, None] & inverse.determined[None, :]  # (gyro, axis)
    earth_rates = _earth(turns, statics, earth)
    matrix, less_earth = np.eye(3), values
    for _ in range(EARTH_ITERATIONS):
        less_earth = (
            values - np.array([rate.known for rate in earth_rates]).reshape(-1, 3) @ matrix.T
        )
        matrix = np.where(columns, (matrix_factors @ np.nan_to_num(less_earth)).T, np.eye(3))

    scatters = np.array([scatter * turn.seconds.sum() for turn in turns] + [scatter] * len(statics))
    noise = [turn.quiet_density * np.sqrt(turn.seconds.sum()) for turn in turns]
    noise += [static.sigma for static in statics]
    readings = Readings(less_earth, np.hypot(np.array(noise).reshape(-1, 3), scatters[:, None]))
    for j, rate in enumerate(earth_rates):
        readings.add_earth(j, rate, matrix, earth.up_sigma)
        for gyro, axis in np.argwhere(~columns):
            change = CROSS_SIGMA * rate.known[axis] * np.eye(3)[gyro]
            readings.add_cause("unknown", f"{gyro} {axis}", j, change)
    for j, turn in enumerate(turns):
        readings.add_cause("angle", str(j), j, matrix @ turn.about * turn.angle_sigma)
        timed = matrix @ turn.about * turn.angle * turn.clock_sigma
        readings.add_cause(CLOCK, turn.clock, j, timed)
        readings.add_tilts(j, turn.position.name, turn.about, turn.angle, matrix, position_sigma)

    def solution(bias_factors: Array) -> Solution:
        """M, and the bias as a mean of readings that hold D + M E."""
        weights = np.broadcast_to(np.vstack([matrix_factors, bias_factors]), (3, 4, n))
        return readings.solution(weights, np.column_stack([columns, recorded]))

    by_rests = None
    if statics:
        ups = np.array([turned(s.position.up, s.about, s.angle) for s in statics])
        by_rests = solution(np.append(np.zeros(len(turns)), pooling(ups)[1].mean(axis=0)))
    return TurnAndStop(solution(offset_factors.mean(axis=0)) if pairs else None, by_rests, pairs)


def _earth(
    turns: Sequence[RateSegment], statics: Sequence[StaticRate], earth: Earth
) -> list[SummedEarthRate]:
    """The earth's rate in every sum, rad, and in every mean, rad/s."""
    moving = [(t.position, t.about, _angles(t), t.seconds) for t in turns]
    at_rest = [(s.position, s.about, np.array([s.angle]), np.ones(1)) for s in statics]
    return [summed_earth_rate(earth, *item) for item in moving + at_rest]


def _angles(turn: RateSegment) -> Array:
    """The angle at the middle of each block, by the gyros along the axis.

    Their excess over the known angle is bias and earth rate, constant during the turn.
    """
    along = np.nan_to_num(turn.sums) @ turn.about
    if abs(along.sum()) < abs(turn.angle) / 2:  # no gyro along the axis was recorded
        along = np.zeros(len(turn.seconds))
    own = along + (turn.angle - along.sum()) * turn.seconds / turn.seconds.sum()
    return np.asarray(np.cumsum(own) - own / 2)
