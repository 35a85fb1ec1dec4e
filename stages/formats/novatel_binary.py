"""A binary message of a NovAtel receiver; layouts in `novatel_messages`."""

import numpy as np

from stages.formats.compiled import compiled, inlined
from stages.formats.crc32 import crc32
from stages.formats.gps_time import NANOSECONDS, WEEK
from stages.formats.little_endian import four, two
from stages.formats.novatel_items import (
    COUNTS,
    DAMAGE,
    IMU,
    LAST_WEEK,
    MORE,
    NOTHING,
    OTHER_BINARY,
    STAMP,
    STATUS,
    TYPE,
    UNSURE,
    WEEK_NS,
    Bytes,
    Fields,
)
from stages.formats.novatel_messages import (
    BODY_BYTES,
    CRC_BYTES,
    EXTENDED,
    LONG_BYTES,
    LONG_SYNC,
    NUMBER,
    SHORT,
    SHORT_BYTES,
    SHORT_SYNC,
    SYNC,
    TEXT,
    WANTED,
)

# Which of the IMU messages has a long header (0) or a short one (1), and this number; −1: none.
_NUMBERED = np.full((2, 1 << 16), -1, np.int8)
for _which, _wanted in enumerate(WANTED):
    if not _wanted[TEXT]:
        _NUMBERED[_wanted[SHORT], _wanted[NUMBER]] = _which

_POWERS = 2.0 ** (np.arange(0x7FF) - 1075.0)  # what the exponents of IEEE 754 stand for

_ANSWER = 0x80  # this bit of the long header's type: the answer to a command, no log


@compiled
def binary_begins(data: Bytes, place: int) -> bool:
    """Whether a binary message may begin at `place`, as far as the bytes go."""
    left = len(data) - place
    if data[place] != SYNC[0] or (left > 1 and data[place + 1] != SYNC[1]):
        return False
    return left < 3 or data[place + 2] == LONG_SYNC or data[place + 2] == SHORT_SYNC


@compiled
def binary(data: Bytes, place: int, last: bool, n: int, into: Fields) -> tuple[int, int, int]:
    """The binary message at `place`; if of the IMU, its fields become number `n` of `into`.

    `last`: nothing follows the data in the file.

    Returns
    -------
    what it is; which of the IMU messages, or its number; the byte after it, or what `novatel_items`
    has instead
    """
    if place < 0:
        return DAMAGE, 0, NOTHING
    left = len(data) - place
    if not binary_begins(data, place):
        return DAMAGE, 0, NOTHING
    if left < SHORT_BYTES:
        return DAMAGE, 0, NOTHING if last else MORE
    long = data[place + 2] == LONG_SYNC
    header, body = SHORT_BYTES, int(data[place + 3])
    if long:
        header, body = body, two(data, place + 8)
        if header != LONG_BYTES:
            return DAMAGE, 0, NOTHING
    number = two(data, place + 4)
    total = header + body + CRC_BYTES
    if left < total:
        return DAMAGE, number, -left if last else MORE
    end, after = place + header + body, place + total
    if crc32(data, place, end) != four(data, end):
        return DAMAGE, number, -total
    which = -1 if long and data[place + 6] & _ANSWER else int(_NUMBERED[int(not long), number])
    if which < 0:
        return OTHER_BINARY, number, after
    extended = WANTED[which, EXTENDED] != 0
    read = body == BODY_BYTES and _body(data, end - BODY_BYTES, extended, n, into)
    return IMU if read else UNSURE, which, after


@inlined
def _body(data: Bytes, first: int, extended: bool, n: int, into: Fields) -> bool:
    """Whether the body that begins at `first` has a time; its fields become number `n`."""
    if first < 0:
        return False
    week = two(data, first + 2) if extended else int(four(data, first))
    seconds = _double(four(data, first + 4), four(data, first + 8))
    if not (week <= LAST_WEEK and 0.0 <= seconds < WEEK):
        return False
    whole = int(seconds)
    part = round((seconds - whole) * NANOSECONDS)
    into[STAMP][n] = week * WEEK_NS + whole * NANOSECONDS + part
    into[STATUS][n] = four(data, first + 12)
    for field in range(6):
        into[COUNTS][n, field] = np.int32(four(data, first + 16 + 4 * field))
    into[TYPE][n] = data[first + 1] if extended else -1
    return True


@compiled
def _double(low: np.uint32, high: np.uint32) -> float:
    """The number of IEEE 754 whose two halves these are; −1 for what is negative or no number."""
    exponent = int(np.int64(high >> np.uint32(20)))
    if exponent >= 0x7FF:
        return -1.0
    fraction = int(low) | (int(high) & 0xFFFFF | (0x100000 if exponent else 0)) << 32
    return float(fraction * _POWERS[max(exponent, 1)])
