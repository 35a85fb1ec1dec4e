"""Bias instability between stretches of time: 1/f noise as a sum of Gauss-Markov processes.

The power density of both sides is B²/(2π f). A Gauss-Markov process of variance s² and time
constant τ has 2 s² τ/(1 + (2π f τ)²), so with s² = B²/π per unit of ln τ they add up to it:

    ∫ 2 (B²/π) τ/(1 + (2π f τ)²) d ln τ = B²/(2π f).

One process per factor `RATIO` of τ is within 0.3 % of that. The slowest band ends at the span τ₁ of
the campaign: the level of what is slower is part of the bias, and within the campaign it changes as
a random walk with K² = ∫ 2 (B²/π)/τ d ln τ = 2 B²/(π τ₁). In means over T seconds what is faster
than τ₀ ≪ T is white, with the variance 2 (B²/π) τ₀/T.

The mean m over a stretch, with x₀ at its start and x₁ at its end, r = T/τ, has in units of s²

    var m = 2 (r − 1 + e⁻ʳ)/r²,   cov(m, x₀) = cov(m, x₁) = (1 − e⁻ʳ)/r,   cov(x₀, x₁) = e⁻ʳ.

Within a stretch of T seconds the bias goes about its mean as a sum of √2 c cos(kπ t/T), k = 1, 2 …
in which c has nearly the variance S(k/2T)/T = B²/(π k), whatever T is: by its autocovariance, which
is −B²/π ln |t| and a constant, B²/(π k) (1 − 1/5k) within 4 % of that for k = 1, 1 % beyond, and
two of them are correlated by 0.12 at most.

Source: IEEE Std 952-2020, bias instability; van der Ziel, Physica 16 (1950) 359, the sum.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array

RATIO = 4.0  # from one time constant to the next
FASTEST_SHARE = 0.125  # of the shortest stretch: what is faster is white, to 2 % of s²
MIN_RATIO = 1e-3  # of T to τ: below it, series
MAX_WAVES = 40  # within a stretch
LEAST_SHARE = 0.1  # of the white noise, below which a wave is left out


@dataclass(frozen=True)
class Instability:
    """Processes of B = 1: time `constants`, s, (k,), of one `variance` each.

    `fastest`: τ₀, s, below which all is white; `walk`: K of what is slower than τ₁, per √s.
    """

    constants: Array
    variance: float
    fastest: float
    walk: float

    @classmethod
    def between(cls, shortest: float, span: float) -> "Instability":
        """Of stretches of at least `shortest` seconds within `span` seconds."""
        count = max(int(np.ceil(np.log(span / shortest / FASTEST_SHARE) / np.log(RATIO))), 1)
        constants = np.asarray(span * RATIO ** -(np.arange(count) + 0.5), np.float64)
        variance, walk = np.log(RATIO) / np.pi, np.sqrt(2 / np.pi / span)
        return cls(constants, float(variance), float(span * RATIO**-count), float(walk))

    def white(self, seconds: Array | float) -> Array:
        """Variance of a mean over so many seconds by all that is faster."""
        return np.asarray(2 * self.fastest / np.pi / seconds)

    def covariance(self, starts: Sequence[float], seconds: Sequence[float]) -> Array:
        """Of the means over n stretches in the order of time that do not overlap, (n, n).

        Without what is slower than τ₁.
        """
        start, length = np.array(starts), np.array(seconds)
        pause = np.maximum(start[None, :] - (start + length)[:, None], 0.0)
        later = np.triu(np.ones(pause.shape, bool), 1)
        result = np.diag(self.white(length))
        for constant in self.constants:
            own, ends, _ = moments(length, constant)
            across = np.where(later, np.outer(ends, ends) * np.exp(-pause / constant), 0.0)
            result += self.variance * (np.diag(own) + across + across.T)
        return np.asarray(result)


def moments(seconds: Array | float, constants: Array | float) -> tuple[Array, Array, Array]:
    """var m, cov(m, x₀) and cov(x₀, x₁) of a process of unit variance over a stretch."""
    ratio = np.asarray(seconds / constants, np.float64)
    safe = np.maximum(ratio, MIN_RATIO)
    kept = np.exp(-ratio)
    mean = 2 * (safe - 1 + np.exp(-safe)) / safe**2
    mixed = (1 - np.exp(-safe)) / safe
    small = ratio < MIN_RATIO
    return (
        np.where(small, 1 - ratio / 3 + ratio**2 / 12, mean),
        np.where(small, 1 - ratio / 2 + ratio**2 / 6, mixed),
        kept,
    )


def waves_within(seconds: float, instability: Array, white: Array) -> Array:
    """The sigma of each wave about the mean of a stretch, (waves, channels), above the white noise.

    `instability`: B of each channel; `white`: its white noise, B · √s.
    """
    known = np.isfinite(white) & (white > 0)
    ratio = np.divide(instability, white, out=np.zeros(len(white)), where=known)
    count = min(int(float(np.max(ratio)) ** 2 * seconds / np.pi / LEAST_SHARE), MAX_WAVES)
    order = np.arange(1, count + 1)[:, None]
    return np.asarray(instability * np.sqrt((1 - 1 / (5 * order)) / (np.pi * order)))


def wave(number: int, fraction: Array) -> Array:
    """A wave of unit power at fractions of the stretch, `number` from 1."""
    return np.asarray(np.sqrt(2) * np.cos(number * np.pi * fraction))
