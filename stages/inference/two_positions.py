"""A gyro from rests with its axis up and its axis down, with the sigmas that S0 leaves out.

    b = (ω̃_up + ω̃_down) / 2,   s = (ω̃_up − ω̃_down) / (2 ω_e sinφ) − 1        (S0 3-13, 3-14)

The level part of the earth's rate reaches the gyro through its cross terms and through the tilt
of each position: γ ω_e cosφ is 0.1 °/h for γ = 7.6 mrad in Wuhan. Where the azimuth is known it is
taken out, else it adds to the sigmas.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.inference.whole_turns import Earth, Position
from stages.model.motion import level_axes

Array = NDArray[np.float64]

KNOWN = 3.0  # sigmas by which the upward earth rate must be known, or it shows no scale factor


@dataclass(frozen=True)
class Upright:
    """A rest with the axis of the gyro up or down: its mean, rad/s, and the sigma of noise."""

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
    """S0's formulas; None unless the axis was up and down.

    Parameters
    ----------
    cross : (3,), what the gyro senses of rates along x, y, z; 0 along its own axis
    position_sigma : tilt of each position, rad
    """
    up = np.array([rest.up > 0 for rest in rests], dtype=np.bool_)
    if up.all() or not up.any():
        return None
    # Where the axis stood up several times, the mean of smallest variance.
    weight = np.array([rest.sigma**-2 for rest in rests])
    share = np.where(up, weight / weight[up].sum(), weight / weight[~up].sum())
    bias, bias_variance = _combined(rests, share / 2, cross, earth, position_sigma)
    if abs(earth.up) < KNOWN * earth.up_sigma:
        return TwoPositions(bias, float(np.sqrt(bias_variance)), None, None)
    signed = np.where(up, share, -share) / (2 * earth.up)
    ratio, variance = _combined(rests, signed, cross, earth, position_sigma)
    variance += (ratio * earth.up_sigma / earth.up) ** 2
    return TwoPositions(bias, float(np.sqrt(bias_variance)), ratio - 1, float(np.sqrt(variance)))


def _combined(
    rests: Sequence[Upright], factors: Array, cross: Array, earth: Earth, position_sigma: float
) -> tuple[float, float]:
    """A weighted sum of the means, the known level earth rate taken out, and its variance.

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
        axes, name = level_axes(position.up), position.name
        if position.mark is not None:
            axes, name = (position.mark, np.cross(position.up, position.mark)), "the table"
        part = factor * earth.level * np.array([cross @ axis for axis in axes])
        coupled[name] = coupled.get(name, np.zeros(2)) + part
    variance += sum(float(part @ part) / 2 for part in coupled.values())
    return float(value), float(variance)
