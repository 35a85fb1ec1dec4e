"""Consecutive places that belong together, and readings that are held over several of them."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.signal.detector import Log, Piece

# ---- Consecutive places that belong together.

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


# ---- The readings of a sensor that measures less often than its log has records.


def new_readings(axes: Array) -> Booleans:
    """Which records, (n,), have a reading of their own: they do not repeat all axes, (n, 3).

    An axis that is not recorded, NaN, says nothing; the first record is new.
    """
    change = np.nan_to_num(np.diff(axes, axis=0)) != 0
    return np.append(np.ones(min(len(axes), 1), bool), change.any(axis=1))


def records_of_a_reading(held: float) -> float:
    """How many records have the same reading, by the share of records that repeat one."""
    return 1 / (1 - held)


def readings_of(piece: Piece, log: Log, i: int) -> tuple[Integers, Array]:
    """Where channel i has readings, (m,), and what it reads there; of a slower sensor new ones."""
    places, values = piece.channel(i)
    if not log.held[i // 3] or not len(places):
        return places, values
    new = new_readings(piece.values[places, 3 * (i // 3) : 3 * (i // 3) + 3])
    return places[new], values[new]
