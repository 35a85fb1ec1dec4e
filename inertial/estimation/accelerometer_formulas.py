"""The accelerometers by the formulas of the sources."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_formulas import Readings, Solution
from inertial.estimation.least_squares import pseudo_inverse

CROSS_SIGMA = 0.01  # rad, of a cross term that is not determined: mounting within half a degree


@dataclass(frozen=True)
class Upright:
    """A static position with the axis up (+1) or down (−1): mean, m/s², and sigma of noise."""

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
    statics: Sequence[Upright], gravity: float, gravity_sigma: float, position_sigma: float
) -> UpAndDown | None:
    """An accelerometer from two positions, its axis up and its axis down, with small tilts (S1).

        b = (f̃_up + f̃_down) / 2,   s = (f̃_up − f̃_down) / (2 g) − 1 + σ²

    A tilt δ of the axis reduces each reading by g (1 − cos |δ|), with the sign of the reading: so
    the bias is unaffected, and the scale factor is short by |δ|²/2, of which σ² is the expectation
    where each of two tilts has the sigma σ, and by which it scatters. Through the cross terms a
    tilt acts in first order, and they are not determined by two positions.

    None unless the axis was up and down. Positions of one direction are averaged.
    """
    directions = [[static for static in statics if static.up * sign > 0] for sign in (1, -1)]
    if not all(directions):
        return None
    means, variances = [], []
    for own in directions:
        weight = np.array([static.sigma**-2 for static in own])
        means.append(float(np.average([static.mean for static in own], weights=weight)))
        tilt = (CROSS_SIGMA * gravity * position_sigma) ** 2 * 2 / len(own)
        variances.append(1 / weight.sum() + tilt)
    bias_sigma = float(np.sqrt(sum(variances))) / 2
    # |δ|²/2 of two tilts is exponential: its sigma is its mean; independent between positions.
    fewest = min(len(own) for own in directions)
    shortfall = position_sigma**2
    scatter = shortfall / np.sqrt(2 * fewest)
    return UpAndDown(
        (means[0] + means[1]) / 2,
        float(np.hypot(bias_sigma, gravity * scatter)),
        (means[0] - means[1]) / (2 * gravity) - 1 + shortfall,
        float(np.sqrt((bias_sigma / gravity) ** 2 + scatter**2 + (gravity_sigma / gravity) ** 2)),
    )


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


def pooled_positions(
    statics: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> Solution | None:
    """M and bias, m/s², by S3, with their covariance; None where the attitudes do not span them.

        N_a = M A,   M̂ = N_a Aᵀ (A Aᵀ)⁻¹

    Stops at the same attitude count as one position: the stop after the forward rotation and the
    stop after the backward rotation are averaged first, whatever their length, which reduces the
    table's position error by √2 where the two are independent. A holds (g u, 1) of each attitude,
    as in S0. Readings of one `position` share its tilt. `scatter`, m/s²: between static positions,
    beyond noise and tilt.
    """
    if not statics:
        return None
    ups = np.array([static.up for static in statics])
    attitudes, shares = pooling(ups)
    span = pseudo_inverse(np.column_stack([gravity * attitudes, np.ones(len(attitudes))]))
    means = np.array([static.mean for static in statics])
    if not span.determined.all() or not np.isfinite(means).all():
        return None
    weights = np.broadcast_to(span.inverse @ shares, (3, 4, len(statics)))
    matrix = np.einsum("kj,jr->rk", weights[0], means)[:, :3]
    readings = Readings(means, np.hypot(np.array([static.sigma for static in statics]), scatter))
    for j, static in enumerate(statics):
        readings.add_cause("gravity", "", j, matrix @ static.up * gravity_sigma)
        readings.add_tilts(j, static.position, static.up, gravity, matrix, position_sigma)
    return readings.solution(weights, np.ones((3, 4), dtype=np.bool_))
