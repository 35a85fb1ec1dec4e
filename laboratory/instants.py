"""The instants at which the truth is computed: the ends of every sample interval, two between.

They are the four nodes of Lobatto's rule, which is exact for polynomials of degree 5:
∫ y dt ≈ h/12 (y₀ + 5 y₁ + 5 y₂ + y₃), nodes at 0, (1 ∓ 1/√5)/2, 1 of the interval h. For a
vibration of 20 Hz at 100 samples a second its error is 3e-6 of the amplitude (Simpson's: 9e-4,
about a count). Abramowitz & Stegun, 25.4.32.
"""

from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np

from laboratory.arrays import Array

NODES_PER_INTERVAL = 3  # the fourth is the first of the next interval
INNER_NODES = (0.5 - 0.5 / sqrt(5), 0.5 + 0.5 / sqrt(5))


@dataclass(frozen=True)
class Instants:
    """The instants of `samples` consecutive sample intervals; m = 3 samples + 1."""

    start: float  # s since the campaign's first sample: where the first interval begins
    samples: int
    interval: float  # s
    late: float = 0.0  # s: all instants earlier by this delay of a sensor

    @cached_property
    def elapsed(self) -> Array:
        """Time since the start, (m,), s; it begins at -late."""
        nodes = np.array([0.0, *INNER_NODES])
        inside = (np.arange(self.samples)[:, None] + nodes).ravel()
        return np.append(inside, self.samples) * self.interval - self.late

    @property
    def time(self) -> Array:
        """Time since the campaign's first sample, (m,), s."""
        return self.start + self.elapsed

    def since(self, moment: float) -> Array:
        """0 before a moment, s since the campaign's first sample, and 1 from it on: (m,).

        The values at the inner nodes of its interval are such that the integral is exact.
        """
        after = (self.time >= moment).astype(float)
        ends = self.time[::NODES_PER_INTERVAL]
        within = int(np.searchsorted(ends, moment)) - 1
        if 0 <= within < self.samples:
            share = (ends[within + 1] - moment) / self.interval
            first = NODES_PER_INTERVAL * within + 1
            after[first : first + 2] = (12 * share - 1) / 10
        return after

    def integral(self, values: Array) -> Array:
        """Integral over every interval: values (m, …) → (samples, …), their unit × s."""
        ends = values[::NODES_PER_INTERVAL]
        inner = values[1::NODES_PER_INTERVAL] + values[2::NODES_PER_INTERVAL]
        return self.interval / 12 * (ends[:-1] + 5 * inner + ends[1:])

    def difference(self, values: Array) -> Array:
        """Value at the end less value at the start of every interval: (m, …) → (samples, …)."""
        return np.diff(values[::NODES_PER_INTERVAL], axis=0)
