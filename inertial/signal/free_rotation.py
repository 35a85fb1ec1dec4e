"""Rotation about a changing axis, seen by two gyros: whether the third may stand still in it."""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.signal.rests_and_motions import MIN_HAND_RATE
from inertial.signal.scatter import BLOCK, in_blocks, median

APART = 8  # readings, from one to the next of three of which the changes are compared
MIN_RATIO = 10.0  # times noise, or a count, by which the rates change sideways in a free rotation
WITHIN_COUNT = 1 / np.sqrt(2 * np.pi)  # of σ counts: σ times the chance to be in the middle one
MAX_STILL_COUNTS = 1.5  # between the readings of a block: one at most


@dataclass(frozen=True)
class FreeRotation:
    """Blocks of readings in which the other two gyros are turned about a changing axis.

    chance: (k,), that of the third one to stay within one count in a block, 1 where they are not;
    still: (k,), where it does.
    """

    chance: Array
    still: Booleans

    @classmethod
    def beside(cls, axis: int, rates: Array, noise: Array, count: float) -> "FreeRotation":
        """As seen beside an axis, 0 to 2.

        A rate that differs by σ counts as freely as the other two do is within half a count with
        the chance 1 / (σ √(2π)) at a time, and for a whole block with less.

        rates: (n, 3), rad/s, NaN where not recorded; noise: (3,), rad/s, NaN of an axis that
        never changes; count: rad/s
        """
        others = np.delete(np.arange(3), axis)
        across = _sideways(rates[:, others])
        least = MIN_RATIO * np.nanmax([count, *noise[others]])
        blocks = rates[: len(across) * BLOCK].reshape(-1, BLOCK, 3)
        extent = np.fmax.reduce(blocks, axis=1) - np.fmin.reduce(blocks, axis=1)
        free = (across > least) & (extent[:, others] > MIN_HAND_RATE).all(axis=1)
        chance = np.ones(len(across))
        chance[free] = WITHIN_COUNT * count / across[free]
        return cls(chance, extent[:, axis] <= MAX_STILL_COUNTS * count)

    def chance_of(self, first: int, after: int) -> float:
        """The chance to stay within one count in the readings [first, after).

        In no block less than the share in which the axis stood still in such a rotation elsewhere:
        a mechanism may turn about all axes but this one.
        """
        start = np.arange(len(self.chance)) * BLOCK
        inside = (start >= first) & (start + BLOCK + 2 * APART <= after)
        elsewhere = (self.chance < 1) & ((start + BLOCK <= first) | (start >= after))
        share = float(self.still[elsewhere].mean()) if elsewhere.any() else 0.0
        return float(np.prod(np.maximum(self.chance[inside], share)))


def _sideways(rates: Array) -> Array:
    """By how much two rates change across their change just before, by blocks, (k,), rad/s.

    About one axis, however it lies and whatever the biases, two rates keep the ratio of their
    changes, and nothing is left across it but noise. It is the median of a block, so that where one
    turn ends as another begins does not count. Readings that are not there count as unchanged.

    rates: (n, 2), rad/s
    """
    change = np.nan_to_num(rates[APART:] - rates[:-APART])
    before, after = change[:-APART], change[APART:]
    length = np.maximum(np.hypot(*before.T), np.hypot(*after.T))
    area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    across = in_blocks(np.divide(area, length, out=np.zeros_like(area), where=length > 0))
    return median(across) if len(across) else np.empty(0)
