"""Robust measures of the scatter of readings, and their smallest step."""

from math import comb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array

MAD_TO_SIGMA = 1.4826  # sigma of Gaussian values in units of the median of their absolute values
BLOCK = 64  # readings
QUIET_SHARE = 0.25  # of the blocks, those with the least change, that count as quiet
MIN_RELATIVE_STEP = 1e-9  # of a reading: smaller steps are rounding of equal readings
MIN_NOISE_COUNTS = 0.8  # what alternates between two counts has 0.71, and no noise


def median(values: NDArray[Any], axis: int = -1) -> NDArray[Any]:
    """The median of finite values along an axis.

    Rows are sorted, which for many short ones takes a third of `numpy.median`; a vector, which may
    be long, is only parted at its middle.
    """
    values = np.moveaxis(values, axis, -1)
    half, odd = divmod(values.shape[-1], 2)
    parted = np.sort(values, axis=-1) if values.ndim > 1 else np.partition(values, half)
    upper = parted[..., half]
    lower = upper if odd else parted[..., :half].max(axis=-1)
    return np.asarray((lower + upper) / 2)


def roughness(values: Array, order: int = 1) -> float:
    """The root mean square change between readings, divided by √2, in the quiet blocks of (n,).

    For white noise of σ and a count q it is √(σ² + q²/12), of increments that carry over
    √(σ² + q²/4), if σ is no less than half a count. NaN for fewer readings than a block has.
    Differences of a higher order have the same of white noise, and less of a smooth motion.
    """
    square = in_blocks(np.diff(values, order) ** 2 / comb(2 * order, order))
    return float(np.sqrt(np.quantile(square.mean(axis=1), QUIET_SHARE))) if len(square) else np.nan


def smallest_step(values: Array) -> float:
    """The smallest change between readings, (n,), which is a count; infinite if there is none.

    Readings are counts times their size, so that equal steps differ in their last digits.
    """
    changes = np.abs(np.diff(values))
    real = changes > MIN_RELATIVE_STEP * np.abs(values).max(initial=0.0)
    return float(changes[real].min(initial=np.inf))


def in_blocks(values: Array, length: int = BLOCK) -> Array:
    """Values in blocks, (k, length), without those that are left over."""
    return values[: len(values) // length * length].reshape(-1, length)


def rounded_mean(noise: Array | float) -> Array:
    """Standard deviation, in steps, of the mean of any number of readings rounded to steps.

    On average over where the truth lies between two steps, by the noise σ before, in steps: the
    k-th harmonic of the error of the mean is exp(−2 π² k² σ²) / (π k), so that it is √(1/12)
    without noise, 0.004 for σ = 0.45. Widrow & Kollár, Quantization Noise, 2008.
    """
    power = sum(np.exp(-((2 * np.pi * k * np.asarray(noise)) ** 2)) / k**2 for k in range(1, 200))
    return np.asarray(np.sqrt(power / (2 * np.pi**2)))


# The variance of rounded readings in steps² by their noise in steps, on average as above.
_NOISE = np.linspace(0.0, 1.0, 201)
_VARIANCE = _NOISE**2 + 1 / 12 - rounded_mean(_NOISE) ** 2


def noise_before_rounding(variance: Array | float) -> Array:
    """Noise of readings before they were rounded to steps, in steps, by the variance after it.

    Up to a noise of 1 step.
    """
    return np.asarray(np.interp(variance, _VARIANCE, _NOISE))
