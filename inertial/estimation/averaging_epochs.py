"""Variances of parameters that are solved from every epoch of the static positions.

    parameter = Σ weight · reading + constant

All static positions are cut into epochs of one length; the k-th epochs give the k-th value, the
means of the first k epochs its running mean. S0 (tables 5-3, 5-4; figures 5-3 to 5-8) gives the
variances of both, for epochs of one sample. That of single epochs decreases as 1/T for white noise
alone. That of running means describes their excursion, not the sigma of the last one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array


@dataclass(frozen=True)
class Formula:
    """p parameters as sums over the r readings of the rests: `weights` (p, r), `constant` (p,)."""

    weights: Array
    constant: Array

    def of(self, readings: Array) -> Array:
        """The parameters, (k, p), of readings (k, r)."""
        return np.asarray(readings @ self.weights.T + self.constant)

    def sigma(self, densities: Array, seconds: float) -> Array:
        """Sigmas by white noise of `densities` (r,), per √s, after so many seconds, (p,)."""
        return np.asarray(np.sqrt(self.weights**2 @ densities**2 / seconds))


@dataclass(frozen=True)
class Spread:
    """Variances of values that are solved epoch by epoch, (p,) each.

    `single`, `running`: variances of the values by single epochs and by running means.
    """

    samples: int  # of an epoch
    epochs: int
    single: Array
    running: Array


def in_epochs(readings: Array, length: int) -> tuple[Array, Array]:
    """Means over single epochs, and over all epochs up to each, (k, r) each.

    Parameters
    ----------
    readings : (n, r), samples of all rests side by side, NaN where masked
    length : samples of an epoch; an incomplete last epoch is not used
    """
    k = len(readings) // length
    cut = readings[: k * length].reshape(k, length, -1)
    sums, counts = np.nansum(cut, axis=1), np.isfinite(cut).sum(axis=1)
    with np.errstate(invalid="ignore"):
        return sums / counts, np.cumsum(sums, axis=0) / np.cumsum(counts, axis=0)


def spread(formula: Formula, readings: Array, lengths: Sequence[int]) -> list[Spread]:
    """The variances for epochs of several lengths in samples; at least two epochs of each."""
    result = []
    for length in lengths:
        single, running = (formula.of(part) for part in in_epochs(readings, length))
        if len(single) > 1:
            variances = [np.nanvar(values, axis=0, ddof=1) for values in (single, running)]
            result.append(Spread(length, len(single), *variances))
    return result
