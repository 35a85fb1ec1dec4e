"""Bias and scale factor of a gyro from a window of two turns, forward and backward.

    b = (α̃₁ + α̃₂ − (1 + s)(α₁ + α₂)) / (2T) − ω_e,   s = (α̃₁ − α̃₂) / (α₁ − α₂) − 1

S0 (3-9), (3-10), where α₁ = −α₂. A window of N intervals lies between N + 1 edges and holds N
samples: its angle at a set rate ω is N · step · ω. Who sums N + 1 samples has a scale factor that
is too large by 1/N (design study, T11).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Window:
    """m windows of two turns: first edge, and the edge after the last sample, (m,) each.

    `seconds`, `forward`, `backward`: (m,), s and rad, how long each lasts and the angle of the
    table in it; forward positive, backward negative.
    """

    first: Integers
    after: Integers
    seconds: Array
    forward: Array
    backward: Array


def at_set_rate(first: Integers, samples: Integers | int, step: float, rate: float) -> Window:
    """Windows of N samples, whose angle is that of the set rate (rad/s) in N steps."""
    after = first + samples
    seconds = np.asarray((after - first) * step, dtype=np.float64)
    return Window(first, after, seconds, abs(rate) * seconds, -abs(rate) * seconds)


def by_angles(window: Window, forward: Array, backward: Array) -> Window:
    """The same windows, their angles by those of the table at every edge, (n + 1,) each."""
    one, other = (angle[window.after] - angle[window.first] for angle in (forward, backward))
    return Window(window.first, window.after, window.seconds, one, other)


def edges_of(increments: Array) -> Array:
    """The angle at the edges of n increments, from 0 on, (n + 1,)."""
    return np.append(0.0, np.cumsum(increments))


def solved(window: Window, forward: Array, backward: Array, earth: float) -> tuple[Array, Array]:
    """Scale factor errors, and biases in rad/s, (m,) each.

    Parameters
    ----------
    forward, backward : (n + 1,), rad, the angle that the gyro summed, at the edges of its samples
    earth : rad/s, upward earth rate along the gyro
    """
    one, other = (summed[window.after] - summed[window.first] for summed in (forward, backward))
    scale = (one - other) / (window.forward - window.backward) - 1
    left = one + other - (1 + scale) * (window.forward + window.backward)
    return np.asarray(scale), np.asarray(left / (2 * window.seconds) - earth)


def noise_of(
    window: Window, densities: tuple[float, float], each: Array | float = 0.0
) -> tuple[Array, Array]:
    """Sigma of scale factor errors and biases, (m,) each.

    Parameters
    ----------
    densities : rad/√s, white noise of the gyro in the turn forward and backward
    each : rad, what else either angle suffers, each for itself: a ripple that is cut, a level rate
    """
    variance = (densities[0] ** 2 + densities[1] ** 2) * window.seconds + 2 * np.square(each)
    size = np.sqrt(variance)
    return np.asarray(size / (window.forward - window.backward)), size / (2 * window.seconds)
