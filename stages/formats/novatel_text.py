"""A text message of a NovAtel receiver: header; body * checksum, and a line end.

    %RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b

The checksum is over what stands between the first character and the '*'.
"""

import numpy as np

from stages.formats.compiled import compiled, inlined
from stages.formats.crc32 import crc32
from stages.formats.eight import TENS, digits, first_of
from stages.formats.gps_time import NANOSECONDS, WEEK
from stages.formats.novatel_items import (
    COUNTS,
    IMU,
    LAST_WEEK,
    MORE,
    NOTHING,
    OTHER_TEXT,
    STAMP,
    STATUS,
    TYPE,
    UNSURE,
    WEEK_NS,
    Bytes,
    Fields,
)
from stages.formats.novatel_messages import (
    EXTENDED,
    LONG_FIELDS,
    NAME_BYTES,
    NAME_LENGTH,
    SHORT,
    SHORT_FIELDS,
    TEXT,
    WANTED,
)
from stages.formats.pieces import LONGEST_LINE

DIGITS = 8  # of the checksum, hexadecimal in lower case

FEED, RETURN, SPACE, TAB = 10, 13, 32, 9
PERCENT, HASH, STAR = ord("%"), ord("#"), ord("*")
_COMMA, _SEMICOLON, _MINUS, _POINT = (ord(character) for character in ",;-.")
_NO_DIGIT = 255
_DIGIT = np.full(256, _NO_DIGIT, np.uint8)
_DIGIT[list(b"0123456789abcdef")] = range(16)
_LONGEST_NUMBER = 10  # digits
_DECIMALS = 9
# Which of the IMU messages has a long header (0) or a short one (1), and a name of this length.
_SPELT = np.full((2, 1 + WANTED[:, NAME_LENGTH].max()), -1)
for _which, _wanted in enumerate(WANTED):
    if _wanted[TEXT]:
        _SPELT[_wanted[SHORT], _wanted[NAME_LENGTH]] = _which


@compiled
def text(data: Bytes, place: int, last: bool, n: int, into: Fields) -> tuple[int, int, int]:
    """The text message at `place`; arguments and what is returned as for `binary`.

    Of a message that is not of the IMU, the length of its name is told.
    """
    if place < 0:
        return OTHER_TEXT, 0, NOTHING
    stop = first_of(FEED, data, place)
    if stop - place >= LONGEST_LINE:
        return OTHER_TEXT, 0, NOTHING
    if stop == len(data) and not last:
        return OTHER_TEXT, 0, MORE
    end = stop - 1 if data[stop - 1] == RETURN else stop
    star = end - DIGITS - 1
    if not right(data, place, star, end):  # then the message may end before the line does
        star = place + 1
        while star < end and data[star] != STAR:
            star += 1
        if not right(data, place, star, end):
            return OTHER_TEXT, 0, NOTHING
    after = star + 1 + DIGITS
    rest = after
    while rest < stop and (data[rest] == RETURN or data[rest] == SPACE or data[rest] == TAB):
        rest += 1
    if rest == stop:  # nothing but the line end follows
        after = min(stop + 1, len(data))
    what, which = _fields(data, place, star, n, into)
    return what, which, after


@compiled
def right(data: Bytes, place: int, star: int, stop: int) -> bool:
    """Whether the text from `place` to its '*' has the checksum that follows, before `stop`."""
    if place < 0 or star <= place or star + DIGITS >= stop or data[star] != STAR:
        return False
    stated = np.uint32(0)
    for k in range(star + 1, star + 1 + DIGITS):
        digit = _DIGIT[data[k]]
        if digit == _NO_DIGIT:
            return False
        stated = stated << np.uint32(4) | np.uint32(digit)
    return bool(crc32(data, place + 1, star) == stated)


@inlined
def _fields(data: Bytes, place: int, star: int, n: int, into: Fields) -> tuple[int, int]:
    """What the text from `place` to `star` is, and which; its fields, where it is of the IMU."""
    if place < 0:
        return OTHER_TEXT, 0
    i = place + 1
    while i < star and data[i] != _COMMA and data[i] != _SEMICOLON:
        i += 1
    which = _named(data, place, i - place - 1)
    if which < 0:
        return OTHER_TEXT, i - place - 1
    header = 1
    while i < star and data[i] != _SEMICOLON:
        header += data[i] == _COMMA
        i += 1
    wanted = WANTED[which]
    if i == star or header != (SHORT_FIELDS if wanted[SHORT] else LONG_FIELDS):
        return UNSURE, which
    read = _body(data, i, star, wanted[EXTENDED] != 0, n, into)
    return IMU if read else UNSURE, which


@inlined
def _body(data: Bytes, i: int, star: int, extended: bool, n: int, into: Fields) -> bool:
    """Whether the fields behind the ';' at `i` are as they should be; they become number `n`."""
    if i < 0:
        return False
    kind, good = -1, True
    if extended:
        i += 1
        while i < star and data[i] != _COMMA:  # what the IMU says of itself
            i += 1
        kind, i, good = _whole(data, i + 1, star)
        good = good and 0 <= kind <= 255
    week, i, good_week = _whole(data, i + 1, star)
    seconds, i, good_seconds = _nanoseconds(data, i + 1, star)
    word, i, good_word = _word(data, i + 1, star)
    good = good and good_week and good_seconds and good_word
    if not (good and 0 <= week <= LAST_WEEK):
        return False
    for field in range(6):
        value, i, good = _whole(data, i + 1, star)
        if not good or (i == star) != (field == 5) or not -(2**31) <= value < 2**31:
            return False
        into[COUNTS][n, field] = value
    into[STAMP][n], into[STATUS][n], into[TYPE][n] = week * WEEK_NS + seconds, word, kind
    return True


@inlined
def _named(data: Bytes, place: int, length: int) -> int:
    """Which of the IMU messages begins at `place` and has a name of this length; −1: none."""
    if length >= _SPELT.shape[1]:
        return -1
    which = int(_SPELT[int(data[place] == PERCENT), length])
    for k in range(length if which >= 0 else 0):
        if NAME_BYTES[which, k] != data[place + 1 + k]:
            return -1
    return which


@inlined
def _whole(data: Bytes, i: int, stop: int) -> tuple[int, int, bool]:
    """The whole number at `i`, where it ends, and whether it is one; at `stop` is no digit."""
    if i < 0 or i >= stop:
        return 0, stop, False
    negative = data[i] == _MINUS
    first = i + 1 if negative else i
    value, i = digits(data, first)
    good = first < i <= first + _LONGEST_NUMBER and (i == stop or data[i] == _COMMA)
    return -value if negative else value, i, good


@inlined
def _word(data: Bytes, i: int, stop: int) -> tuple[np.uint32, int, bool]:
    """The hexadecimal number at `i`, where it ends, and whether it is one of at most 8 digits."""
    if i < 0:
        return np.uint32(0), 0, False
    value, first = np.uint32(0), i
    while i < stop and _DIGIT[data[i]] != _NO_DIGIT:
        value = value << np.uint32(4) | np.uint32(_DIGIT[data[i]])
        i += 1
    return value, i, first < i <= first + DIGITS and i < stop and data[i] == _COMMA


@inlined
def _nanoseconds(data: Bytes, i: int, stop: int) -> tuple[int, int, bool]:
    """The seconds at `i`, of at most nine decimals, in ns, where they end, if they are such."""
    if i < 0 or i >= stop:
        return 0, stop, False
    first = i
    value, i = digits(data, first)
    good = 0 < i - first <= _LONGEST_NUMBER and value < WEEK
    decimals, missing = 0, _DECIMALS
    if data[i] == _POINT:
        first = i + 1
        decimals, i = digits(data, first)
        missing -= i - first
    value = value * NANOSECONDS + decimals * TENS[max(missing, 0)]
    return value, i, good and missing >= 0 and i < stop and data[i] == _COMMA
