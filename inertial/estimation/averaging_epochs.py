"""Parameters that are linear in readings at rest, solved anew from every epoch of the rests.

    parameter = Σ weight · reading + constant

All rests are cut into epochs of one length; the k-th epochs of all rests give the k-th value, the
means of the first k epochs its running mean. S0 (tables 5-3, 5-4; figures 5-3 to 5-8) gives the
variances of both, of epochs of one sample. That of single epochs falls as 1/T by white noise alone;
where it does not, what is read is no white noise. That of running means says how far they
wandered, not how sure the last one is.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Formula:
    """p parameters as sums over the r readings of the rests: `weights` (p, r), `constant` (p,)."""

    weights: Array
    constant: Array

    def of(self, readings: Array) -> Array:
        """The parameters, (k, p), of readings (k, r)."""
        return np.asarray(readings @ self.weights.T + self.constant)

    def sigma(self, densities: Array, seconds: float) -> Array:
        """What white noise of `densities` (r,), per √s, leaves after so many seconds, (p,)."""
        return np.asarray(np.sqrt(self.weights**2 @ densities**2 / seconds))


@dataclass(frozen=True)
class Spread:
    """How values scatter that are solved epoch by epoch, (p,) each.

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
    length : samples of an epoch; what is left over at the end is not used
    """
    k = len(readings) // length
    cut = readings[: k * length].reshape(k, length, -1)
    sums, counts = np.nansum(cut, axis=1), np.isfinite(cut).sum(axis=1)
    with np.errstate(invalid="ignore"):
        return sums / counts, np.cumsum(sums, axis=0) / np.cumsum(counts, axis=0)


def spread(formula: Formula, readings: Array, lengths: Sequence[int]) -> list[Spread]:
    """The variances for epochs of several lengths in samples; at least two epochs of each."""
    found = []
    for length in lengths:
        single, running = (formula.of(part) for part in in_epochs(readings, length))
        if len(single) > 1:
            variances = [np.nanvar(values, axis=0, ddof=1) for values in (single, running)]
            found.append(Spread(length, len(single), *variances))
    return found
