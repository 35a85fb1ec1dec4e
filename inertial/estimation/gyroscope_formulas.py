"""The gyros by the formulas of the sources."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.estimation.gyroscope_equations import horizontal_axes, horizontal_names
from inertial.estimation.gyroscope_observations import Earth, Position, WholeTurn
from inertial.estimation.horizontal_earth_rate import SummedEarthRate
from inertial.physics.motion import cross, level_axes

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

    with the bias b of the joint estimate. An asymmetry of the scale factor, and any error that
    occurs during rotation only, makes the two differ.

    The difference is c (b_turns − b) with c = t/α forward less t/α backward, where b_turns is the
    bias by the two turns alone: an error of b enters the two scale factors with opposite sign. The
    joint bias b is from data that contain these turns, so the two are correlated: its estimate is
    efficient, and so it gives b_turns the weight σ_b²/σ_turns². Without `scatter`, the scatter
    between manoeuvres in the joint estimate (rad/s), this leaves σ² = c² (σ_turns² − σ_b²), after
    Hausman (1978). The scatter is not counted as noise of the turns: it represents unmodelled
    effects, which are what is tested here.
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
    shared = of_bias / (noise + offsets) * noise
    of_earth = forward.up * forward.seconds / forward.angle
    of_earth -= backward.up * backward.seconds / backward.angle
    variance = abs(noise + of_bias - 2 * shared) + (of_earth * earth.up_sigma) ** 2
    return BothWays(scales[0], scales[1], float(variance**0.5))
