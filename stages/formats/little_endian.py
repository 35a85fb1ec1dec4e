"""Numbers of two, four and eight bytes of a log, the lowest byte first, for compiled loops."""

import numpy as np

from stages.formats.compiled import inlined
from stages.formats.novatel_items import Bytes


@inlined
def two(data: Bytes, place: int) -> int:
    """The number of the two bytes from `place` on."""
    return int(data[place]) | int(data[place + 1]) << 8


@inlined
def four(data: Bytes, place: int) -> np.uint32:
    """The number of the four bytes from `place` on."""
    word = np.uint32(0)
    for k in range(4):
        word |= np.uint32(data[place + k]) << np.uint32(8 * k)
    return word


@inlined
def eight(data: Bytes, place: int) -> np.uint64:
    """The number of the eight bytes from `place` on."""
    return np.uint64(four(data, place)) | np.uint64(four(data, place + 4)) << np.uint64(32)
