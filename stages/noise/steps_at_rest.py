"""Whether a single manoeuvre changes by a step at rest, which the noise would take for a drift.

A bias that jumps, or an IMU that is moved, within one manoeuvre looks there like a random walk, and
a random walk of that size would hide it: every manoeuvre would be allowed to differ as much. A
drift is in all. So where the static stretches of comparable length in other manoeuvres show none,
what those of one manoeuvre show is no drift.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from inertial.arrays import Array, Booleans

MOST_MEANS = 64  # of a stretch that are kept
LEAST_MEANS = 16
CLEAR = 60.0  # squared ratio of a step to its sigma
QUIET = 25.0  # the same, which noise alone exceeds in one of 500
COMPARABLE = 0.5  # of the length of a stretch, that others have at least
LEAST_OTHERS = 3
NORMAL = 0.6745  # median of |x| of a standard normal variable


@dataclass
class Course:
    """Means over equal parts of a stretch, piece by piece, in bounded memory; c channels."""

    means: list[Array] = field(default_factory=list)
    each: int = 1  # samples in a mean
    _rest: list[Array] = field(default_factory=list)

    def add(self, values: Array) -> None:
        """The next samples, (n, c)."""
        joined = np.concatenate([*self._rest, values])
        while (len(self.means) + len(joined) // self.each) > MOST_MEANS:
            if len(self.means) % 2:  # an odd one waits for the other half of its pair
                joined = np.concatenate([np.repeat(self.means[-1:], self.each, axis=0), joined])
                self.means.pop()
            self.means = [
                (a + b) / 2 for a, b in zip(self.means[::2], self.means[1::2], strict=True)
            ]
            self.each *= 2
        whole = len(joined) // self.each * self.each
        self.means += list(joined[:whole].reshape(-1, self.each, joined.shape[1]).mean(axis=1))
        self._rest = [joined[whole:]]

    def step(self) -> tuple[int, Array]:
        """Samples, and of each channel the largest squared ratio of a step to its sigma, (c,)."""
        k = len(self.means)
        if k < LEAST_MEANS:
            return 0, np.zeros(0)
        means = np.array(self.means)
        changes = np.abs(np.diff(means, axis=0))
        variance = (np.median(changes, axis=0) / NORMAL) ** 2 / 2
        sums, place = np.cumsum(means - means.mean(axis=0), axis=0)[:-1], np.arange(1, k)
        squares = sums**2 * (k / (place * (k - place)))[:, None]
        return k * self.each, squares.max(axis=0) / np.where(variance > 0, variance, np.inf)


@dataclass(frozen=True)
class Step:
    """Of the static stretch of a manoeuvre, see `Course.step`."""

    manoeuvre: str
    samples: int
    ratios: Array


def of_one_manoeuvre(steps: Sequence[Step], channels: int) -> Booleans:
    """Of which channels a single manoeuvre alone changes by a step at rest, (c,)."""
    known = [step for step in steps if step.samples]
    found = np.zeros(channels, bool)
    for step in known:
        least = COMPARABLE * step.samples
        others = [
            other.ratios
            for other in known
            if other.manoeuvre != step.manoeuvre and other.samples >= least
        ]
        if len(others) >= LEAST_OTHERS:
            found |= (step.ratios > CLEAR) & (np.array(others) < QUIET).all(axis=0)
    return found
