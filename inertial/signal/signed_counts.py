"""Counts that are written without their sign: of 16 bits −1 is written as 65535."""

from collections.abc import Sequence

import numpy as np

from inertial.arrays import Array

WORD_BITS = (16, 24, 32)
MIN_LEAPS, MAX_LEFT = 5, 0.1  # over half the range; share of them that the sign must not leave


def signed(counts: Array, bits: int) -> Array:
    """Counts of so many bits with their sign."""
    half = 2.0 ** (bits - 1)
    return np.asarray((counts + half) % (2 * half) - half)


def bits_without_sign(recordings: Sequence[Array]) -> int | None:
    """The bits of counts, (n, 3) each, that leap over their range where they pass zero, or None.

    No motion takes a sensor from one end of its range to the other between two samples.
    """
    counts = [own[np.isfinite(own).all(axis=1)] for own in recordings]
    if any(own.min(initial=0) < 0 or (own % 1).any() for own in counts):
        return None
    most = max((own.max(initial=0) for own in counts), default=0)
    for bits in WORD_BITS:
        if most >= 2**bits:
            continue
        leaps, left = (
            sum(int((np.abs(np.diff(own, axis=0)) > 2 ** (bits - 1)).sum()) for own in each)
            for each in (counts, [signed(own, bits) for own in counts])
        )
        if leaps >= MIN_LEAPS and left < MAX_LEFT * leaps:
            return bits
    return None
