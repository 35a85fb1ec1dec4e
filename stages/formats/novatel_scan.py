"""Where each message in the bytes of a NovAtel log begins and ends, and what those of the IMU say.

A text message ends at its line end, a binary one where its header says. What is neither, or has not
the right checksum, is refused up to the next line end, or to the next message that is whole, or
to where a binary one may begin: a damage costs what is damaged.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.formats.compiled import compiled
from stages.formats.novatel_binary import binary, binary_begins
from stages.formats.novatel_items import (
    DAMAGE,
    EMPTY,
    GOES_ON,
    MORE,
    NOTHING,
    STAMP,
    Bytes,
    Fields,
)
from stages.formats.novatel_messages import SYNC
from stages.formats.novatel_text import (
    DIGITS,
    FEED,
    HASH,
    PERCENT,
    RETURN,
    SPACE,
    STAR,
    TAB,
    right,
    text,
)
from stages.formats.pieces import LONGEST_LINE, Integers

MOST = 1 << 16  # items of one scan
KEPT = 4096  # bytes at the end of an endless line that may be the beginning of a message

# What the items are, which, and where each begins and the last one ends: (n,), (n,), (n + 1,).
_Items = tuple[NDArray[np.int8], NDArray[np.int32], Integers]


@dataclass(frozen=True)
class Scan:
    """The n items of some bytes, one behind the other; the arrays have one entry each, (n,)."""

    what: NDArray[np.int8]  # as in `novatel_items`
    start: Integers  # byte where it begins
    length: Integers  # byte
    which: NDArray[np.int32]  # of the IMU messages, of the numbers, or the length of the name
    fields: Fields  # of items of the IMU, else anything
    consumed: int  # the byte after the last


def scan(data: Bytes, start: int, *, last: bool) -> Scan:
    """The items of `data` from `start` on; `last`: nothing follows it in the file."""
    what, which = np.empty(MOST, np.int8), np.empty(MOST, np.int32)
    bounds = np.empty(MOST + 1, np.int64)
    stamp, status = np.empty(MOST, np.int64), np.empty(MOST, np.uint32)
    counts = np.empty((MOST, 6), np.int32, order="F")  # by columns, as it is used
    fields = (stamp, status, counts, np.empty(MOST, np.int16))
    n = _scan(data, start, last, (what, which, bounds), fields)
    bounds = bounds[: n + 1]
    some: tuple[NDArray[np.generic], ...] = tuple(part[:n] for part in fields)
    return Scan(
        what[:n],
        bounds[:-1],
        np.diff(bounds),
        which[:n],
        some,  # type: ignore[arg-type]
        int(bounds[-1]),
    )


@compiled
def _scan(data: Bytes, start: int, last: bool, items: _Items, into: Fields) -> int:
    """Fill in items and their fields; return how many there are."""
    items_what, items_which, bounds = items
    place, n = start, int(np.int64(0))  # a bare 0 is a type of its own: all compiled twice
    bounds[0] = place
    while place < len(data) and n < len(into[STAMP]):
        what, which, after = DAMAGE, 0, NOTHING
        if data[place] == SYNC[0]:
            what, which, after = binary(data, place, last, n, into)
        elif data[place] == PERCENT or data[place] == HASH:
            what, which, after = text(data, place, last, n, into)
        if after < 0:
            what, after = _damage(data, place, last, 0 if after == NOTHING else -after)
        if after == MORE:
            break
        items_what[n], items_which[n], bounds[n + 1] = what, which, after
        place = after
        n += 1
    return n


@compiled
def _damage(data: Bytes, place: int, last: bool, length: int) -> tuple[int, int]:
    """What the bytes from `place` are, where no message is whole; the byte after them, or MORE.

    `length`: of a damaged binary message, in which line ends mean nothing; 0: it is text.
    """
    stop = place + length if length else len(data)
    if length and not last and stop + len(SYNC) > len(data):
        return DAMAGE, MORE  # the next message may begin with the last of these bytes
    found, end, unfinished = _message_among(data, place, stop, length == 0)
    if found > 0:
        return DAMAGE, min(found, stop)
    if end == len(data) and not last and (not length or unfinished):
        if end - place <= LONGEST_LINE:
            return DAMAGE, MORE
        if not length:
            return GOES_ON, end - KEPT
    if length:
        return DAMAGE, stop
    after = min(end + 1, len(data))
    blank = after - place <= LONGEST_LINE and _blank(data, place, end)
    return EMPTY if blank else DAMAGE, after


@compiled
def _message_among(data: Bytes, place: int, stop: int, lines: bool) -> tuple[int, int, bool]:
    """Where a message begins behind `place`: a whole text, or what may be a binary one; or −1.

    It is sought up to `stop`, and as far as a text goes that begins before; `lines`: up to a line
    end. And where the search ended, and whether in the middle of a text.
    """
    start = -1  # of a text
    i = place
    while i < len(data) and (i < stop or start > 0):
        byte = data[i]
        if byte == FEED and (lines or i >= stop):
            break
        if i > place:
            if byte == SYNC[0] and i + 2 < len(data) and binary_begins(data, i):
                return i, i, False
            if byte in (PERCENT, HASH):
                start = i
            elif byte == STAR and start > 0:
                if right(data, start, i, len(data)):
                    return start, i, False
                if i + DIGITS >= len(data):  # its checksum may be in what follows
                    return -1, len(data), True
                start = -1
        i += 1
    return -1, i, start > 0


@compiled
def _blank(data: Bytes, place: int, end: int) -> bool:
    """Whether there is nothing but blanks."""
    i = place
    while i < end and (data[i] == SPACE or TAB <= data[i] <= RETURN):
        i += 1
    return i == end
