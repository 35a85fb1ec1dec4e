"""The accelerometers by the formulas of the sources."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_formulas import CROSS_SIGMA, Readings, Solution, pooling
from inertial.estimation.least_squares import pseudo_inverse


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


def six_position_weights(ups: Array, gravity: float) -> Array | None:
    """The twelve unknowns (M by rows, bias) per reading of n rests by S0 (3-6), (12, n, 3).

        M̂ = L Aᵀ (A Aᵀ)⁻¹,   L the means of the rests,   A = [g u; 1]

    None where the attitudes u, (n, 3), do not span the four columns.
    """
    truth = np.vstack([gravity * ups.T, np.ones(len(ups))])
    if np.linalg.matrix_rank(truth) < 4:
        return None
    inverse = truth.T @ np.linalg.inv(truth @ truth.T)  # (n, 4)
    each = np.einsum("nk,rc->rknc", inverse, np.eye(3))  # of row r by the readings of channel c
    return np.concatenate([each[:, :3].reshape(9, -1, 3), each[:, 3]])


def six_position_formula(
    statics: Sequence[StaticForce],
    gravity: float,
    gravity_sigma: float,
    position_sigma: float,
    scatter: float = 0.0,
) -> tuple[Array, Array] | None:
    """M and bias by S0 (3-6), the rests without weights, and their covariance.

    None where the attitudes do not span the four columns of `six_position_weights`.

    Returns
    -------
    the twelve unknowns (M by rows, bias) and their covariance
    """
    ups, means = (np.array([getattr(s, name) for s in statics]) for name in ("up", "mean"))
    weights = six_position_weights(ups, gravity)
    if weights is None or not np.isfinite(means).all():
        return None
    noise = np.array([static.sigma for static in statics]) ** 2 + scatter**2
    covariance = np.einsum("anc,nc,bnc->ab", weights, noise, weights)
    # An error of gravity is upward; that of a tilt horizontal, and the same for one position.
    up = np.einsum("anc,nc->an", weights, ups)
    covariance += gravity_sigma**2 * np.outer(up.sum(axis=1), up.sum(axis=1))
    names = np.array([static.position for static in statics])
    for position in dict.fromkeys(names):
        every, upward = weights[:, names == position].sum(axis=1), up[:, names == position]
        horizontal = every @ every.T - np.outer(upward.sum(axis=1), upward.sum(axis=1))
        covariance += (position_sigma * gravity) ** 2 * horizontal
    return np.einsum("anc,nc->a", weights, means), covariance


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
