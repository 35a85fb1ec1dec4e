"""Consecutive places that belong together."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Booleans, Integers

# Samples in a row that are interpolated in a motion by hand, which changes its rate in 50 ms
MAX_LOST_RUN = 3


def runs(there: Booleans) -> Iterator[tuple[int, int]]:
    """The runs of consecutive True in (n,): first place, and place after the last."""
    edges = np.flatnonzero(np.diff(there, prepend=False, append=False))
    yield from zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


def joined(places: Integers, apart: int) -> Iterator[tuple[int, int]]:
    """Runs of ascending places of which no more than `apart` lie between one and the next."""
    if len(places):
        breaks = np.flatnonzero(np.diff(places) > apart + 1)
        first, last = np.append(0, breaks + 1), np.append(breaks, len(places) - 1)
        yield from zip(places[first].tolist(), (places[last] + 1).tolist(), strict=True)
