"""The accelerometers by the formulas of the sources."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_formulas import Readings, Solution
from inertial.estimation.least_squares import pseudo_inverse
from inertial.physics.motion import level_axes
from inertial.physics.vectors import cross

# ---- An accelerometer from two positions, its axis up and its axis down, tilted a little.
#
#     b = (f̃_up + f̃_down) / 2,   s = (f̃_up − f̃_down) / (2 g) − 1 + σ²
#
# S1's two positions with tilt. A tilt δ of the axis takes g (1 − cos |δ|) off each reading, with
# the same sign as the reading: so the bias does not feel it, and the scale factor is short by
# |δ|²/2, of which σ² is expected where each of two tilts has the sigma σ, and by which it
# scatters. Through the cross terms a tilt is felt in proportion, and they are not known from two
# positions.

CROSS = 0.01  # rad, a mounting askew by half a degree: a cross term that nobody determined


@dataclass(frozen=True)
class Upright:
    """A rest with the axis up (+1) or down (−1): its mean, m/s², and the sigma of noise."""

    up: float
    mean: float
    sigma: float


@dataclass(frozen=True)
class UpAndDown:
    """Bias, m/s², and scale factor error, with their sigmas."""

    bias: float
    bias_sigma: float
    scale: float
    scale_sigma: float


def up_and_down(
    rests: Sequence[Upright], gravity: float, gravity_sigma: float, position_sigma: float
) -> UpAndDown | None:
    """S1's formulas; None unless the axis was up and down. Rests of one kind are averaged."""
    ways = [[rest for rest in rests if rest.up * sign > 0] for sign in (1, -1)]
    if not all(ways):
        return None
    means, variances = [], []
    for own in ways:
        weight = np.array([rest.sigma**-2 for rest in own])
        means.append(float(np.average([rest.mean for rest in own], weights=weight)))
        leaning = (CROSS * gravity * position_sigma) ** 2 * 2 / len(own)
        variances.append(1 / weight.sum() + leaning)
    spread = float(np.sqrt(sum(variances))) / 2
    # |δ|²/2 of two tilts is exponential: its deviation is its mean; of each position its own.
    fewest = min(len(own) for own in ways)
    shortfall = position_sigma**2
    scatter = shortfall / np.sqrt(2 * fewest)
    return UpAndDown(
        (means[0] + means[1]) / 2,
        float(np.hypot(spread, gravity * scatter)),
        (means[0] - means[1]) / (2 * gravity) - 1 + shortfall,
        float(np.sqrt((spread / gravity) ** 2 + scatter**2 + (gravity_sigma / gravity) ** 2)),
    )


# ---- The accelerometers by S3: stops at the same attitude count as one position.
#
#     N_a = M A,   M̂ = N_a Aᵀ (A Aᵀ)⁻¹
#
# The stop that the forward turn reaches and the stop that the backward turn reaches are averaged
# first, whatever their length, which lessens the table's position error by √2 where the two are
# independent. A holds (g u, 1) of each attitude, as in S0.

Array = NDArray[np.float64]


def pooling(ups: Array) -> tuple[Array, Array]:
    """Which rests stand at the same attitude.

    Parameters
    ----------
    ups : (n, 3), upward directions in body axes

    Returns
    -------
    attitudes (m, 3), and the shares of the rests in their means (m, n)
    """
    attitudes, number = np.unique(np.round(ups, 9) + 0.0, axis=0, return_inverse=True)
    members = number.ravel()[None, :] == np.arange(len(attitudes))[:, None]
    return attitudes, members / members.sum(axis=1, keepdims=True)


def pooled_positions(
    rests: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> Solution | None:
    """M and bias, m/s², with their covariance; None where the attitudes do not span them.

    Rests of one `position` share its tilt. `scatter`, m/s², is by what readings differ from rest
    to rest beyond that.
    """
    if not rests:
        return None
    ups = np.array([rest.up for rest in rests])
    attitudes, shares = pooling(ups)
    span = pseudo_inverse(np.column_stack([gravity * attitudes, np.ones(len(attitudes))]))
    means = np.array([rest.mean for rest in rests])
    if not span.determined.all() or not np.isfinite(means).all():
        return None
    weights = np.broadcast_to(span.inverse @ shares, (3, 4, len(rests)))
    matrix = np.einsum("kj,jr->rk", weights[0], means)[:, :3]
    readings = Readings(means, np.hypot(np.array([rest.sigma for rest in rests]), scatter))
    for j, rest in enumerate(rests):
        readings.suffer("gravity", "", j, matrix @ rest.up * gravity_sigma)
        for i, axis in enumerate(level_axes(rest.up)):
            lean = gravity * cross(axis, rest.up) * position_sigma
            readings.suffer(f"tilt {i}", rest.position, j, matrix @ lean)
    return readings.solution(weights, np.ones((3, 4), dtype=np.bool_))
