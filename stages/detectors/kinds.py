"""The records of a piece by what they hold: sensors may come in rows of their own."""

from collections.abc import Iterator

import numpy as np

from stages.detectors.detector import Integers, Piece


def kinds(piece: Piece) -> Iterator[tuple[Integers, Integers]]:
    """For each set of channels that are recorded together: the places, (m,), and the channels.

    Records of which nothing is to be used any more are in none.
    """
    there = np.isfinite(piece.values)
    if there.all():
        yield np.arange(len(piece)), np.arange(there.shape[1])
        return
    code = there @ (1 << np.arange(there.shape[1]))
    for each in np.unique(code[code > 0]):
        channels = np.flatnonzero(each >> np.arange(there.shape[1]) & 1)
        yield np.flatnonzero(code == each), channels
