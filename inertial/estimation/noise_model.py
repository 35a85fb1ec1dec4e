"""The stochastic model of the noise of a rate, after IEEE Std 952-2020, annex C.

Five terms, of the rate Ω (of a gyro, or the specific force of an accelerometer; U its unit):

    term              coefficient   density of both sides S(f)     Allan variance σ²(τ)
    quantisation      Q  U·s        Q² · 4 sin²(πfΔ) / Δ           3 Q² / τ²
    white noise       N  U/√Hz      N²                             N² / τ
    bias instability  B  U          B² / (2π f)                    (2 ln 2 / π) B²
    random walk       K  U/√s       K² / (2π f)²                   K² τ / 3
    ramp              R  U/s        a deterministic drift R t      R² τ² / 2

Δ is the sampling interval. A sample is the mean of the rate over its interval, as an increment is:
white noise scatters by N/√Δ; means over longer intervals follow the same model with the same
coefficients, and the Allan variances above are exact at any multiple of Δ.

The four stochastic terms are given by the generalised autocovariance s(t) of the angle (the
integral of the rate), from which that of any differences follows (Greenhall and Riley, PTTI 2003;
a quadratic polynomial of t is free, for it is lost with the second differences):

    Q² δ(t)    − N² |t| / 2    B² t² ln|t| / (2π)    K² |t|³ / 12
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from inertial.arrays import Array

SQRT2 = float(np.sqrt(2))
FLOOR_VARIANCE = 2 * float(np.log(2)) / np.pi  # Allan variance of a bias instability of 1
STOCHASTIC = ("quantisation", "white_noise", "bias_instability", "random_walk")
TERMS = (*STOCHASTIC, "ramp")
FOLDS = 20  # aliases on each side of a density that are summed, the rest is integrated


@dataclass(frozen=True)
class NoiseModel:
    """The five coefficients of one channel, in units of the rate and s; 0 where a term is absent.

    The ramp has a sign.
    """

    quantisation: float = 0.0
    white_noise: float = 0.0
    bias_instability: float = 0.0
    random_walk: float = 0.0
    ramp: float = 0.0

    @property
    def variances(self) -> Array:
        """The squares of the stochastic coefficients, (4,), in the order of STOCHASTIC."""
        return np.array([getattr(self, name) ** 2 for name in STOCHASTIC])

    def allan_variance(self, tau: ArrayLike) -> Array:
        """σ²(τ) at averaging times in s, multiples of the sampling interval; shape of tau, U²."""
        t = np.asarray(tau, np.float64)
        return np.asarray(self.variances @ allan_shapes(t) + self.ramp**2 * t**2 / 2)

    def density(self, frequency: ArrayLike, interval: float) -> Array:
        """Density of both sides of the sampled rate, U²/Hz; the ramp, a trend, has none.

        `frequency`: Hz, above 0, up to half the sampling rate; `interval`: s.
        """
        return np.asarray(self.variances @ density_shapes(np.asarray(frequency, float), interval))


def sigma_of_mean(white: ArrayLike, quantisation: ArrayLike, seconds: ArrayLike) -> Array:
    """Of a mean over so many seconds, U: white noise N, and the angle's Q at either end of it."""
    time = np.asarray(seconds, np.float64)
    return np.hypot(white / np.sqrt(time), SQRT2 * np.asarray(quantisation) / time)


def allan_shapes(tau: Array) -> Array:
    """Allan variances of the stochastic terms with coefficients of 1, (4, …); tau in s."""
    one = np.ones_like(tau)
    return np.stack([3 / tau**2, 1 / tau, FLOOR_VARIANCE * one, tau / 3])


def density_shapes(frequency: Array, interval: float) -> Array:
    """Densities of the sampled stochastic terms with coefficients of 1, (4, …), s or 1 or ….

    The mean over an interval filters a continuous noise by sinc(fΔ), and sampling folds it.
    """
    turn = frequency * interval  # cycles per sample
    filtered = 4 * np.sin(np.pi * turn) ** 2
    flicker = np.zeros_like(turn)
    for fold in range(-FOLDS, FOLDS + 1):
        flicker += 1 / np.abs(turn + fold) ** 3
    flicker += 2 / (2 * (FOLDS + 0.5) ** 2)  # the folds beyond, as an integral
    return np.stack(
        [
            filtered / interval,
            np.ones_like(turn),
            filtered * flicker * interval / (2 * np.pi) ** 3,
            interval**2 * (1 / filtered - 1 / 6),
        ]
    )


def angle_autocovariance(t: Array) -> Array:
    """s(t) of the stochastic terms with coefficients of 1 at lags in s, (4, …)."""
    lag = np.abs(t)
    logarithm = np.log(np.where(lag > 0, lag, 1.0))
    return np.stack(
        [
            np.where(lag == 0, 1.0, 0.0),
            -lag / 2,
            lag**2 * logarithm / (2 * np.pi),
            lag**3 / 12,
        ]
    )


def rate_autocovariance(count: int, interval: float) -> Array:
    """Generalised autocovariance of the sampled rate at lags 0 … count − 1, (4, count), U².

    −δ²s/Δ², in units of Δ so that nothing is lost in the differences; up to a constant, which the
    mean takes away.
    """
    lag = np.arange(-1.0, count + 1)
    shapes = angle_autocovariance(lag)
    second = 2 * shapes[:, 1:-1] - shapes[:, 2:] - shapes[:, :-2]
    second[3] = -lag[1:-1] / 2  # K²: exact, where the differences of cubes lose digits
    second[3, 0] = -1 / 6
    powers = np.array([-2.0, -1.0, 0.0, 1.0])
    return np.asarray(second * interval ** powers[:, None])


# ---- Bias instability between stretches of time: 1/f noise as a sum of Gauss-Markov processes.
#
# The power density of both sides is B²/(2π f). A Gauss-Markov process of variance s² and time
# constant τ has 2 s² τ/(1 + (2π f τ)²), so with s² = B²/π per unit of ln τ they add up to it:
#
#     ∫ 2 (B²/π) τ/(1 + (2π f τ)²) d ln τ = B²/(2π f).
#
# One process per factor `RATIO` of τ is within 0.3 % of that. The slowest band ends at the span τ₁
# of the campaign: the level of what is slower is part of the bias, and within the campaign it
# changes as a random walk with K² = ∫ 2 (B²/π)/τ d ln τ = 2 B²/(π τ₁). In means over T seconds what
# is faster than τ₀ ≪ T is white, with the variance 2 (B²/π) τ₀/T.
#
# The mean m over a stretch, with x₀ at its start and x₁ at its end, r = T/τ, has in units of s²
#
#     var m = 2 (r − 1 + e⁻ʳ)/r²,   cov(m, x₀) = cov(m, x₁) = (1 − e⁻ʳ)/r,   cov(x₀, x₁) = e⁻ʳ.
#
# Within a stretch of T seconds the bias goes about its mean as a sum of √2 c cos(kπ t/T), k = 1, 2
# … in which c has nearly the variance S(k/2T)/T = B²/(π k), whatever T is: by its autocovariance,
# which is −B²/π ln |t| and a constant, B²/(π k) (1 − 1/5k) within 4 % of that for k = 1, 1 %
# beyond, and two of them are correlated by 0.12 at most.
#
# Source: IEEE Std 952-2020, bias instability; van der Ziel, Physica 16 (1950) 359, the sum.

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
