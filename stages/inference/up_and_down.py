"""An accelerometer from two positions, its axis up and its axis down, tilted a little.

    b = (f̃_up + f̃_down) / 2,   s = (f̃_up − f̃_down) / (2 g) − 1 + σ²

S1's two positions with tilt. A tilt δ of the axis takes g (1 − cos |δ|) off each reading, with the
same sign as the reading: so the bias does not feel it, and the scale factor is short by |δ|²/2, of
which σ² is expected where each of two tilts has the sigma σ, and by which it scatters. Through
the cross terms a tilt is felt in proportion, and they are not known from two positions.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

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
