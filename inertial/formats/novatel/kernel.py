"""Framing, checksums and text fields of the messages in a NovAtel log, compiled by numba.

A text message ends at its line end, a binary one where its header states. Bytes that are neither,
or whose checksum is wrong, are refused up to the next line end, to the next intact message, or to
the next possible start of a binary message, so that damage costs only what is damaged.

The checksum is a CRC-32 with reflected polynomial 0xEDB88320, start 0, not inverted at the end,
computed eight bytes at a time (Kounavis and Berry, IEEE Transactions on Computers 57, 2008).
Source of the format: `imu_messages`.

Everything the compiled code uses is defined in this file, because numba's cache notices a change
of this file only.
"""

import numba
import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Integers

Bytes = NDArray[np.uint8]

# Kinds of items. UNPARSED: an IMU message of right checksum with fields outside the usual notation;
# CONTINUED: the first part of a damaged stretch that extends beyond the data.
IMU, OTHER_TEXT, OTHER_BINARY, BLANK, DAMAGE, CONTINUED, UNPARSED = range(7)

# The number of an IMU message is a sum of these: RAWIMUA 0, RAWIMUSA 1, …, RAWIMUSXB 7.
SHORT, EXTENDED, BINARY = 1, 2, 4

SYNC, LONG_SYNC, SHORT_SYNC = (0xAA, 0x44), 0x12, 0x13  # the first three bytes of a binary message
LONG_BYTES, SHORT_BYTES, BODY_BYTES, CRC_BYTES = 28, 12, 40, 4
RESPONSE = 0x80  # bit of the message type: the response to a command
LONG_FIELDS, SHORT_FIELDS = 10, 3  # of a text header, with the name
CRC_DIGITS = 8  # hexadecimal, lower case

WEEK_S, LAST_WEEK = 604_800, 9999  # GPS week 9999 is in the year 2171
SECOND_NS = 1_000_000_000
MAX_LINE_BYTES = 1 << 20
OVERLAP_BYTES = 4096  # of a damaged stretch without end that may be the start of a message
MAX_NUMBER_DIGITS = 10

# Instead of the byte after a message: more data are needed; there is no message. For a damaged
# binary message with a plausible header: its length, negative.
_MORE, _NO_MESSAGE = 0, -1

_FEED, _RETURN, _SPACE, _TAB = 10, 13, 32, 9
_PERCENT, _HASH, _STAR, _COMMA, _SEMICOLON, _MINUS, _POINT = (ord(char) for char in "%#*,;-.")
_NAME = np.frombuffer(b"RAWIMU", np.uint8)
_NO_DIGIT = 255
_HEXADECIMAL = np.full(256, _NO_DIGIT, np.uint8)
_HEXADECIMAL[list(b"0123456789abcdef")] = range(16)
_POWERS_OF_TEN = 10 ** np.arange(10)


def _crc_tables() -> NDArray[np.uint32]:
    """The contribution of a byte to the checksum when k more bytes follow, (8, 256)."""
    tables = np.zeros((8, 256), np.uint32)
    for byte in range(256):
        value = byte
        for _ in range(8):
            value = value >> 1 ^ (0xEDB88320 if value & 1 else 0)
        tables[0, byte] = value
    for k in range(1, 8):
        tables[k] = tables[k - 1] >> 8 ^ tables[0][tables[k - 1] & 0xFF]
    return tables


_CRC = _crc_tables()

# No function has a chained comparison of array elements, and the smallest are inlined: numba then
# drops the counting of references to the arrays, which would double the time.
_compiled = numba.njit(cache=True, nogil=True)
_inlined = numba.njit(cache=True, nogil=True, inline="always")


@_compiled
def scan(
    data: Bytes,
    start: int,
    last: bool,
    kinds: NDArray[np.int8],
    codes: NDArray[np.int32],
    bounds: Integers,
    stamps: Integers,
    status: NDArray[np.uint32],
    counts: NDArray[np.int32],
    imu_types: NDArray[np.int16],
) -> int:
    """Find the items of `data` from `start` on; return their number n, at most `len(kinds)`.

    `last`: no data follow. Filled in: kinds; codes, the number of an IMU message, of a binary
    message, or the length of a text message's name; bounds, (n + 1,); the fields of IMU messages.
    """
    place, n = start, int(np.int64(0))  # a plain 0 would be compiled as another type
    bounds[0] = place
    while place < len(data) and n < len(kinds):
        kind, code, after, parsed = DAMAGE, 0, _NO_MESSAGE, False
        if data[place] == SYNC[0]:
            kind, code, after = _binary(data, place, last)
            if kind == IMU:
                body = after - CRC_BYTES - BODY_BYTES
                parsed, stamps[n], status[n], imu_types[n] = _body(data, body, code, n, counts)
        elif data[place] == _PERCENT or data[place] == _HASH:
            kind, code, star, after = _text(data, place, last)
            if kind == IMU:
                parsed, stamps[n], status[n], imu_types[n] = _fields(
                    data, place, star, code, n, counts
                )
        if kind == IMU and not parsed:
            kind = UNPARSED
        if after < 0:
            kind, after = _damage(data, place, last, 0 if after == _NO_MESSAGE else -after)
        if after == _MORE:
            break
        kinds[n], codes[n], bounds[n + 1] = kind, code, after
        place = after
        n += 1
    return n


# ---- binary messages


@_inlined
def _binary_begins(data: Bytes, place: int) -> bool:
    """Whether a binary message may begin at `place`, as far as the data go."""
    left = len(data) - place
    if data[place] != SYNC[0] or (left > 1 and data[place + 1] != SYNC[1]):
        return False
    return left < 3 or data[place + 2] == LONG_SYNC or data[place + 2] == SHORT_SYNC


@_compiled
def _binary(data: Bytes, place: int, last: bool) -> tuple[int, int, int]:
    """Kind and code of the binary message at `place`, and the byte after it."""
    if place < 0:
        return DAMAGE, 0, _NO_MESSAGE
    left = len(data) - place
    if not _binary_begins(data, place):
        return DAMAGE, 0, _NO_MESSAGE
    if left < SHORT_BYTES:
        return DAMAGE, 0, _NO_MESSAGE if last else _MORE
    long = data[place + 2] == LONG_SYNC
    header, body = SHORT_BYTES, int(np.int64(data[place + 3]))
    if long:
        header, body = body, _half_word(data, place + 8)
        if header != LONG_BYTES:
            return DAMAGE, 0, _NO_MESSAGE
    number = _half_word(data, place + 4)
    length = header + body + CRC_BYTES
    if left < length:
        return DAMAGE, number, -left if last else _MORE
    end = place + header + body
    if _checksum(data, place, end) != _word(data, end):
        return DAMAGE, number, -length
    code = _binary_code(number, long)
    if not code or (long and data[place + 6] & RESPONSE):
        return OTHER_BINARY, number, place + length
    return IMU if body == BODY_BYTES else UNPARSED, code, place + length


@_inlined
def _binary_code(number: int, long: bool) -> int:
    """The number of the IMU message with this number in a binary header; 0: another message."""
    if number == (268 if long else 325):
        return BINARY if long else BINARY | SHORT
    if number == (1461 if long else 1462):
        return BINARY | EXTENDED if long else BINARY | EXTENDED | SHORT
    return 0


@_compiled
def _body(
    data: Bytes, first: int, code: int, n: int, counts: NDArray[np.int32]
) -> tuple[bool, int, np.uint32, int]:
    """Whether the time in the body from `first` is valid; stamp, ns, status and type of the IMU."""
    if first < 0:
        return False, 0, np.uint32(0), 0
    week, imu_type = int(np.int64(_word(data, first))), int(np.int64(-1))
    if code & EXTENDED:
        week, imu_type = _half_word(data, first + 2), int(np.int64(data[first + 1]))
    low, high = np.uint64(_word(data, first + 4)), np.uint64(_word(data, first + 8))
    seconds = np.uint64(low | high << np.uint64(32)).view(np.float64)
    for k in range(6):
        counts[n, k] = np.int32(_word(data, first + 16 + 4 * k))
    status = _word(data, first + 12)
    # NaN is not smaller.
    valid = week <= LAST_WEEK and bool(seconds < WEEK_S) and not np.signbit(seconds)
    whole = int(np.int64(seconds)) if valid else 0
    ns = int(np.int64(np.rint((seconds - whole) * SECOND_NS))) if valid else 0
    return valid, (week * WEEK_S + whole) * SECOND_NS + ns, status, imu_type


# ---- text messages


@_compiled
def _text(data: Bytes, place: int, last: bool) -> tuple[int, int, int, int]:
    """Kind and code of the text message at `place`, its '*', and the byte after it."""
    if place < 0:
        return OTHER_TEXT, 0, 0, _NO_MESSAGE
    stop = _find(data, place, _FEED)
    if stop - place >= MAX_LINE_BYTES:
        return OTHER_TEXT, 0, 0, _NO_MESSAGE
    if stop == len(data) and not last:
        return OTHER_TEXT, 0, 0, _MORE
    end = stop - 1 if data[stop - 1] == _RETURN else stop
    star = end - CRC_DIGITS - 1
    if not _intact(data, place, star, end):  # the message may end before the line does
        star = _find(data, place + 1, _STAR)
        if not _intact(data, place, star, end):
            return OTHER_TEXT, 0, 0, _NO_MESSAGE
    after = star + 1 + CRC_DIGITS
    rest = after
    while rest < stop and (data[rest] == _RETURN or data[rest] == _SPACE or data[rest] == _TAB):
        rest += 1
    if rest == stop:  # only the line end follows
        after = min(stop + 1, len(data))
    name_end = place + 1
    while name_end < star and data[name_end] != _COMMA and data[name_end] != _SEMICOLON:
        name_end += 1
    code = _imu_name(data, place, name_end)
    if code < 0:
        return OTHER_TEXT, name_end - place - 1, star, after
    return IMU, code, star, after


@_compiled
def _intact(data: Bytes, place: int, star: int, stop: int) -> bool:
    """Whether the text from `place` to its '*' has the checksum that follows, before `stop`."""
    if place < 0 or star <= place or star + CRC_DIGITS >= stop or data[star] != _STAR:
        return False
    stated, end = _hexadecimal(data, star + 1, star + 1 + CRC_DIGITS)
    return end == star + 1 + CRC_DIGITS and _checksum(data, place + 1, star) == stated


@_compiled
def _imu_name(data: Bytes, place: int, end: int) -> int:
    """The number of the IMU message whose name ends before `end`; −1: another message."""
    code = SHORT if data[place] == _PERCENT else 0
    i = place + 1 + len(_NAME)
    if end - i > 3:
        return -1
    for k in range(len(_NAME)):
        if data[place + 1 + k] != _NAME[k]:
            return -1
    if code:
        if data[i] != ord("S"):
            return -1
        i += 1
    if data[i] == ord("X"):
        code |= EXTENDED
        i += 1
    return code if data[i] == ord("A") and i + 1 == end else -1


@_compiled
def _fields(
    data: Bytes, place: int, star: int, code: int, n: int, counts: NDArray[np.int32]
) -> tuple[bool, int, np.uint32, int]:
    """Whether the fields of the IMU message are usual; stamp, ns, status and type of the IMU."""
    if place < 0:
        return False, 0, np.uint32(0), 0
    i, header = place + 1, 1
    while i < star and data[i] != _SEMICOLON:
        header += data[i] == _COMMA
        i += 1
    if i == star or header != (SHORT_FIELDS if code & SHORT else LONG_FIELDS):
        return False, 0, np.uint32(0), 0
    imu_type, valid_type = int(np.int64(-1)), True
    if code & EXTENDED:
        i += 1
        while i < star and data[i] != _COMMA:  # the information byte is not used
            i += 1
        imu_type, i, valid_type = _number(data, i + 1, star, 0)
        valid_type &= (imu_type >= 0) & (imu_type <= 255)
    week, i, valid_week = _number(data, i + 1, star, 0)
    ns, i, valid_ns = _number(data, i + 1, star, 9)
    word, end = _hexadecimal(data, i + 1, star)
    valid = valid_type & valid_week & valid_ns & (end > i + 1) & (end <= i + 1 + 8)
    valid &= bool(data[end] == _COMMA) & (week >= 0) & (week <= LAST_WEEK)
    valid &= (ns >= 0) & (ns < WEEK_S * SECOND_NS)
    i = end
    for k in range(6):
        count, i, valid_count = _number(data, i + 1, star, 0)
        valid &= valid_count & ((i == star) == (k == 5)) & (count >= -(2**31)) & (count < 2**31)
        counts[n, k] = count
    return valid, week * (WEEK_S * SECOND_NS) + ns, word, imu_type


@_compiled
def _number(data: Bytes, i: int, stop: int, decimals: int) -> tuple[int, int, bool]:
    """The decimal number at `i` times 10**decimals, its end, and whether it is valid."""
    if i < 0 or i >= stop:
        return 0, stop, False
    negative = data[i] == _MINUS
    first = i + 1 if negative else i
    value, i = _digits(data, first)
    valid = first < i <= first + MAX_NUMBER_DIGITS
    if decimals:
        fraction, missing = int(np.int64(0)), decimals
        if data[i] == _POINT:
            first = i + 1
            fraction, i = _digits(data, first)
            missing -= i - first
        valid = valid and missing >= 0
        value = value * _POWERS_OF_TEN[decimals] + fraction * _POWERS_OF_TEN[max(missing, 0)]
    valid &= (i == stop) | bool(data[i] == _COMMA)
    return -value if negative else value, i, valid


@_inlined
def _hexadecimal(data: Bytes, i: int, stop: int) -> tuple[np.uint32, int]:
    """The hexadecimal number at `i`, modulo 2³², and its end."""
    value = np.uint32(0)
    if i < 0:
        return value, i
    while i < stop and _HEXADECIMAL[data[i]] != _NO_DIGIT:
        value = value << np.uint32(4) | np.uint32(_HEXADECIMAL[data[i]])
        i += 1
    return value, i


# ---- damage


@_compiled
def _damage(data: Bytes, place: int, last: bool, length: int) -> tuple[int, int]:
    """Kind of the bytes from `place`, where there is no intact message, and the byte after them.

    `length`: of a damaged binary message, in which line ends have no meaning; 0: text.
    """
    stop = place + length if length else len(data)
    if length and not last and stop + len(SYNC) > len(data):
        return DAMAGE, _MORE  # the next message may begin with the last of these bytes
    message, end, unfinished = _message_within(data, place, stop, length == 0)
    if message > 0:
        return DAMAGE, min(message, stop)
    if end == len(data) and not last and (not length or unfinished):
        if end - place <= MAX_LINE_BYTES:
            return DAMAGE, _MORE
        if not length:
            return CONTINUED, end - OVERLAP_BYTES
    if length:
        return DAMAGE, stop
    after = min(end + 1, len(data))
    i = place
    while i < end and (data[i] == _SPACE or _TAB <= data[i] <= _RETURN):
        i += 1
    return BLANK if i == end and after - place <= MAX_LINE_BYTES else DAMAGE, after


@_compiled
def _message_within(data: Bytes, place: int, stop: int, lines: bool) -> tuple[int, int, bool]:
    """Start of an intact text or possible binary message after `place`, or −1.

    The search ends at `stop`, or at the end of a text that begins before it; `lines`: at a line
    end. Also returned: where it ended, and whether within a text.
    """
    start = -1  # of a text
    i = place
    while i < len(data) and (i < stop or start > 0):
        byte = data[i]
        if byte == _FEED and (lines or i >= stop):
            break
        if i > place:
            if byte == SYNC[0] and i + 2 < len(data) and _binary_begins(data, i):
                return i, i, False
            if byte in (_PERCENT, _HASH):
                start = i
            elif byte == _STAR and start > 0:
                if _intact(data, start, i, len(data)):
                    return start, i, False
                if i + CRC_DIGITS >= len(data):  # the checksum may be in the data that follow
                    return -1, len(data), True
                start = -1
        i += 1
    return -1, i, start > 0


# ---- bytes

_BYTE, _B8, _B16, _B24 = np.uint32(0xFF), np.uint32(8), np.uint32(16), np.uint32(24)


@_inlined
def _half_word(data: Bytes, i: int) -> int:
    """Two bytes as a number, the first byte the lowest."""
    return int(np.int64(data[i])) | int(np.int64(data[i + 1])) << 8


@_inlined
def _word(data: Bytes, i: int) -> np.uint32:
    """Four bytes as a number, the first byte the lowest."""
    low = np.uint32(data[i]) | np.uint32(data[i + 1]) << _B8
    return low | np.uint32(data[i + 2]) << _B16 | np.uint32(data[i + 3]) << _B24


@_compiled
def _checksum(data: Bytes, first: int, after: int) -> np.uint32:
    """The checksum of data[first:after]."""
    if first < 0:
        return np.uint32(0)
    crc, i = np.uint32(0), first
    while i + 8 <= after:
        crc = _crc_of_word(_word(data, i) ^ crc, 4) ^ _crc_of_word(_word(data, i + 4), 0)
        i += 8
    if i + 4 <= after:
        crc = _crc_of_word(_word(data, i) ^ crc, 0)
        i += 4
    while i < after:
        crc = _CRC[0, (crc ^ np.uint32(data[i])) & _BYTE] ^ crc >> _B8
        i += 1
    return crc


@_inlined
def _crc_of_word(word: np.uint32, k: int) -> np.uint32:
    """The contribution of four bytes to the checksum when k more follow."""
    first = _CRC[k + 3, word & _BYTE] ^ _CRC[k + 2, word >> _B8 & _BYTE]
    return np.uint32(first ^ _CRC[k + 1, word >> _B16 & _BYTE] ^ _CRC[k, word >> _B24])


@_compiled
def _find(data: Bytes, i: int, byte: int) -> int:
    """The place of the next `byte` from `i` on, or the end of the data."""
    if i < 0:
        return len(data)
    while i < len(data) and data[i] != byte:
        i += 1
    return i


@_inlined
def _digits(data: Bytes, i: int) -> tuple[int, int]:
    """The number of the decimal digits at `i`, valid up to 18 digits, and their end."""
    value = int(np.int64(0))
    if i < 0:
        return value, i
    while i < len(data) and _HEXADECIMAL[data[i]] < 10:
        value = 10 * value + int(np.int64(_HEXADECIMAL[data[i]]))
        i += 1
    return value, i
