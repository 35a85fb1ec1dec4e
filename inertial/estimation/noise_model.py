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

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from inertial.arrays import Array

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
