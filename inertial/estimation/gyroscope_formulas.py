"""The gyros by the formulas of the sources."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.gyroscope_equations import CLOCK, horizontal_axes, horizontal_names
from inertial.estimation.gyroscope_observations import (
    Earth,
    Position,
    RateSegment,
    StaticRate,
    WholeTurn,
)
from inertial.estimation.horizontal_earth_rate import SummedEarthRate, summed_earth_rate
from inertial.estimation.least_squares import pseudo_inverse
from inertial.physics.motion import cross, level_axes, turned

Turn = TypeVar("Turn")

MIN_EARTH_RATE_SIGMAS = 3.0  # of the upward earth rate, else it determines no scale factor

# Sensor by sensor three columns of M and the bias, (3, 4), in the order of the twelve unknowns.
ORDER = np.append(np.arange(12).reshape(3, 4)[:, :3].ravel(), np.arange(12).reshape(3, 4)[:, 3])


@dataclass(frozen=True)
class Solution:
    """M by rows, then the bias, (12,), and their covariance, (12, 12).

    NaN where a parameter is not determined.
    """

    values: Array
    covariance: Array

    @property
    def sigma(self) -> Array:
        """Standard deviations of the values, (12,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def determined(self) -> Booleans:
        """Which of the twelve are determined."""
        return np.isfinite(self.values)


@dataclass
class Readings:
    """n readings of three sensors with the covariance of their errors.

    The sources print formulas that are linear in the readings, without sigma:

        parameter k of sensor r = sum over j of weights[r, k, j] · reading[j, r]

    Errors are noise, independent between readings, and causes that several readings share: the tilt
    of a position, the angle of a rate segment, gravity. `values`: (n, 3); `noise`: (n, 3), standard
    deviations; NaN where not recorded. `causes`: for each shared error its effect at one sigma on
    all readings, (n, 3).
    """

    values: Array
    noise: Array
    causes: dict[tuple[str, str], Array] = field(default_factory=dict)

    def add_cause(self, kind: str, name: str, reading: int, size: Array) -> None:
        """One sigma of the cause changes a reading by `size`, (3,)."""
        if (kind, name) not in self.causes:
            self.causes[kind, name] = np.zeros_like(self.values)
        self.causes[kind, name][reading] += size

    def add_earth(
        self, reading: int, sensed: SummedEarthRate, matrix: Array, up_sigma: float
    ) -> None:
        """The uncertain parts of the earth's rate in a reading by sensors with this M."""
        self.add_cause("earth", "up", reading, matrix @ sensed.up * up_sigma)
        for (kind, name), size in sensed.level.items():
            self.add_cause(kind, name, reading, matrix @ size)

    def add_tilts(
        self, reading: int, position: str, along: Array, size: float, matrix: Array, sigma: float
    ) -> None:
        """The tilt, rad, of a position in which `size` is sensed along a direction, (3,)."""
        for i, level in enumerate(level_axes(along)):
            change = size * cross(level, along) * sigma
            self.add_cause(f"tilt {i}", position, reading, matrix @ change)

    def solution(self, weights: Array, determined: Booleans) -> Solution:
        """The parameters by the formula, with their covariance.

        Parameters
        ----------
        weights : (3, 4, n), zero where a reading is not recorded
        determined : (3, 4)
        """
        values = np.einsum("rkj,jr->rk", weights, np.nan_to_num(self.values)).ravel()[ORDER]
        noise = np.einsum("rkj,jr->rkj", weights, np.nan_to_num(self.noise))
        covariance = np.zeros((3, 4, 3, 4))
        for r in range(3):
            covariance[r, :, r, :] = noise[r] @ noise[r].T
        flat = covariance.reshape(12, 12)[np.ix_(ORDER, ORDER)]
        for size in self.causes.values():
            moved = np.einsum("rkj,jr->rk", weights, size).ravel()[ORDER]
            flat += np.outer(moved, moved)
        missing = ~determined.ravel()[ORDER]
        values[missing] = np.nan
        flat[missing[:, None] | missing[None, :]] = np.nan
        return Solution(values, flat)


def pooling(ups: Array) -> tuple[Array, Array]:
    """The static positions of each attitude.

    Parameters
    ----------
    ups : (n, 3), upward directions in body axes

    Returns
    -------
    attitudes (m, 3), and the weights of the readings in their means (m, n)
    """
    attitudes, number = np.unique(np.round(ups, 9) + 0.0, axis=0, return_inverse=True)
    members = number.ravel()[None, :] == np.arange(len(attitudes))[:, None]
    return attitudes, members / members.sum(axis=1, keepdims=True)


@dataclass(frozen=True)
class Upright:
    """A static position with the axis of the gyro up or down: mean, rad/s, and sigma of noise."""

    position: Position
    up: float  # +1 where the axis points up, −1 where it points down
    mean: float
    sigma: float


@dataclass(frozen=True)
class TwoPositions:
    """Bias, rad/s, and scale factor error with their sigmas; no scale without a known latitude."""

    bias: float
    bias_sigma: float
    scale: float | None
    scale_sigma: float | None


def two_positions(
    rests: Sequence[Upright], cross: Array, earth: Earth, position_sigma: float
) -> TwoPositions | None:
    """A gyro from static positions with its axis up and down, with the sigmas that S0 omits.

        b = (ω̃_up + ω̃_down) / 2,   s = (ω̃_up − ω̃_down) / (2 ω_e sinφ) − 1      (S0 3-13, 3-14)

    The horizontal earth rate couples through the cross terms and the tilt of each position:
    γ ω_e cosφ is 0.1 °/h for γ = 7.6 mrad in Wuhan. Where the azimuth is known it is subtracted,
    else it adds to the sigmas. None unless the axis was up and down.

    Parameters
    ----------
    cross : (3,), cross terms of the gyro for rates about x, y, z; 0 along its own axis
    position_sigma : tilt of each position, rad
    """
    up = np.array([rest.up > 0 for rest in rests], dtype=np.bool_)
    if up.all() or not up.any():
        return None
    # Of several positions of one direction the mean of smallest variance.
    weight = np.array([rest.sigma**-2 for rest in rests])
    share = np.where(up, weight / weight[up].sum(), weight / weight[~up].sum())
    bias, bias_variance = _combined(rests, share / 2, cross, earth, position_sigma)
    if abs(earth.up) < MIN_EARTH_RATE_SIGMAS * earth.up_sigma:
        return TwoPositions(bias, float(np.sqrt(bias_variance)), None, None)
    signed = np.where(up, share, -share) / (2 * earth.up)
    ratio, variance = _combined(rests, signed, cross, earth, position_sigma)
    variance += (ratio * earth.up_sigma / earth.up) ** 2
    return TwoPositions(bias, float(np.sqrt(bias_variance)), ratio - 1, float(np.sqrt(variance)))


def _combined(
    rests: Sequence[Upright], factors: Array, cross: Array, earth: Earth, position_sigma: float
) -> tuple[float, float]:
    """A weighted sum of the means less the known horizontal earth rate, and its variance.

    An unknown azimuth is a random direction; positions with a common mark share it.
    """
    value, variance = 0.0, 0.0
    coupled: dict[str, Array] = {}
    for rest, factor in zip(rests, factors, strict=True):
        position = rest.position
        value += factor * rest.mean
        variance += (factor * rest.sigma) ** 2 + (factor * earth.level * position_sigma) ** 2
        if position.north is not None:
            value -= factor * earth.level * float(cross @ position.north)
            continue
        (_, name), _ = horizontal_names(position)
        part = factor * earth.level * horizontal_axes(position) @ cross
        coupled[name] = coupled.get(name, np.zeros(2)) + part
    variance += sum(float(part @ part) / 2 for part in coupled.values())
    return float(value), float(variance)


def paired(
    forward: Iterable[Turn], backward: Iterable[Turn], alike: Callable[[Turn, Turn], bool]
) -> list[tuple[Turn, Turn]]:
    """Each turn forward with the first one backward that is alike and has no other yet."""
    left, pairs = list(backward), list[tuple[Turn, Turn]]()
    for turn in forward:
        place = next((i for i, other in enumerate(left) if alike(turn, other)), None)
        if place is not None:
            pairs.append((turn, left.pop(place)))
    return pairs


@dataclass(frozen=True)
class BothWays:
    """The scale factor error by each direction, and the sigma of their difference."""

    forward: float
    backward: float
    sigma: float


def both_ways(
    forward: WholeTurn,
    backward: WholeTurn,
    bias: float,
    bias_sigma: float,
    earth: Earth,
    scatter: float = 0.0,
) -> BothWays:
    """The scale factor error of a gyro by a turn forward and by a turn backward.

        s = (α̃ − b t − ω_e sinφ t) / α − 1,   for each direction by itself

    with the bias b of the joint fit. An asymmetry of the scale factor, and any error that
    occurs during rotation only, makes the two differ.

    The difference is c (b_turns − b) with c = t/α forward less t/α backward, where b_turns is the
    bias by the two turns alone: an error of b enters the two scale factors with opposite sign. The
    joint bias b is from data that contain these turns, so the two are correlated: its estimate is
    efficient, and so it gives b_turns the weight σ_b²/σ_turns². Without `scatter`, the scatter
    between manoeuvres in the joint fit (rad/s), this leaves σ² = c² (σ_turns² − σ_b²), after
    Hausman (1978). The scatter is not counted as noise of the turns: it represents unmodelled
    effects, which are what is tested here. A σ_b above σ_turns is by more than white noise, as
    by a drift: then nothing is taken off.
    """
    scales = [
        (turn.summed - (bias + earth.up * turn.up) * turn.seconds) / turn.angle - 1
        for turn in (forward, backward)
    ]
    noise, offsets = 0.0, 0.0
    for turn in (forward, backward):
        noise += (turn.density**2 * turn.seconds + turn.angle_sigma**2) / turn.angle**2
        offsets += (scatter * turn.seconds / turn.angle) ** 2
        if forward.clock != backward.clock:  # else one error of a clock is in both
            noise += turn.clock_sigma**2
    c = forward.seconds / forward.angle - backward.seconds / backward.angle
    of_bias = (c * bias_sigma) ** 2
    white = of_bias < noise + offsets
    shared = of_bias / (noise + offsets) * noise if white else 0.0
    of_earth = forward.up * forward.seconds / forward.angle
    of_earth -= backward.up * backward.seconds / backward.angle
    variance = noise + of_bias - 2 * shared + (of_earth * earth.up_sigma) ** 2
    return BothWays(scales[0], scales[1], float(variance**0.5))


# ---- By S3's own formulas: turns forward and backward, and the stops between them.
#
#     sum over a turn  N± = M (±2π u + E T) + D T
#     N⁺ − N⁻ = 2 · 2π · M u          (S3 13, 14; 2π, not the set rate times the window)
#     N⁺ + N⁻ = 2 T (D + M E)         (S3 15)
#     mean at rest = D + M E
#
# u: axis of the turn, in body axes; D: bias; E: the earth's rate. S3 states that over a turn the
# earth rate integrates to zero. That holds for its horizontal component at a steady rate; ramps
# and standstill leave a remainder, the same in both directions. So the difference is exact, and
# the sum keeps 0.81 °/h (64 s at 6 °/s) and 2.16 °/h (36 s at 12 °/s) on the horizontal gyros, in
# a direction that is known only with the azimuth. The upward component, 7.64 °/h, stays in the sum
# too; it is subtracted, and turns with the axis up and turns with the axis down cancel its error,
# once each sum is divided by its own T: undivided sums of 64 s and 36 s would keep 2.14 °/h.
#
# Where forward and backward differ in angle or duration, the two equations are solved as they are.

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
    noise = [turn.noise_of_sum for turn in turns]
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
