"""Noise of a rate made from its definition, without any code that estimates it.

White noise: independent samples. Bias instability: fractional integration of white noise by half
an order (N. J. Kasdin, Discrete simulation of colored noise, Proc. IEEE 83, 1995, 802), whose
density B² δ / |2 sin(πfδ)| is B² / (2πf) where f δ is small: δ is a quarter of a sampling interval,
of which a sample is the mean. It has run before, for half as long, so that it does not start from
rest. Random walk: a running sum. Quantisation: the integrated angle is rounded to counts of Q √12,
and the samples are its differences; where a count is larger than 1.7 sigma of an increment,
rounding depends on what is rounded, and is no white noise of the angle any more.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, next_fast_len, rfft

from inertial.arrays import Array

OVERSAMPLED = 4
BEFORE = 0.5  # of the recording


@cache
def _half_integration(length: int) -> tuple[NDArray[np.complex128], int]:
    k = np.arange(1.0, length)
    weights = np.cumprod(np.concatenate([[1.0], (k - 0.5) / k]))
    padded = next_fast_len(2 * length, real=True)
    return rfft(weights, padded), padded


def flicker(samples: int, instability: float, chance: np.random.Generator) -> Array:
    """Bias instability B, U; (n,), means over the sampling interval."""
    length = int((1 + BEFORE) * samples) * OVERSAMPLED
    response, padded = _half_integration(length)
    driven = rfft(chance.standard_normal(length), padded)
    made = irfft(response * driven, padded)[length - OVERSAMPLED * samples : length]
    return np.asarray(instability * made.reshape(samples, OVERSAMPLED).mean(axis=1))


def noise(
    samples: int,
    interval: float,
    chance: np.random.Generator,
    *,
    quantisation: float = 0.0,
    white_noise: float = 0.0,
    bias_instability: float = 0.0,
    random_walk: float = 0.0,
    ramp: float = 0.0,
) -> Array:
    """Samples (n,) of the rate; the coefficients of IEEE Std 952, in U and s; interval in s."""
    rate = white_noise / np.sqrt(interval) * chance.standard_normal(samples)
    rate += ramp * interval * np.arange(samples)
    if bias_instability:
        rate += flicker(samples, bias_instability, chance)
    if random_walk:
        rate += random_walk * np.sqrt(interval) * np.cumsum(chance.standard_normal(samples))
    if quantisation:
        count = quantisation * np.sqrt(12)
        angle = chance.uniform(0, count) + np.append(0.0, np.cumsum(rate) * interval)
        rate = np.diff(np.rint(angle / count)) * count / interval
    return np.asarray(rate)
