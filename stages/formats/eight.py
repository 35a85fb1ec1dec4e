"""Eight bytes of a log at a time as one number, the first byte the lowest: line ends and digits.

Byte after byte, a processor guesses where a number ends, and a wrong guess takes it longer than the
number. Source: Warren, "Hacker's Delight", 2nd edition (2013), chapter 6, "Searching
Words".
"""

import numpy as np

from stages.formats.compiled import inlined
from stages.formats.little_endian import eight
from stages.formats.novatel_items import Bytes

_LOWS, _HIGHS = np.uint64(0x0101010101010101), np.uint64(0x8080808080808080)
_ZEROS = _LOWS * np.uint64(ord("0"))
_BEYOND_NINE = _LOWS * np.uint64(0x80 - 10)  # added to 10 or more it makes the highest bit
_PLACES = np.uint64(0x0001020304050607)  # times 256ⁿ it has n in its highest byte
_PAIRS, _FOURS = np.uint64(0x00FF00FF00FF00FF), np.uint64(0x0000FFFF0000FFFF)
_ONE, _SEVEN, _EIGHT, _TOP = np.uint64(1), np.uint64(7), np.uint64(8), np.uint64(56)
TENS = 10 ** np.arange(10)


@inlined
def first_of(byte: int, data: Bytes, place: int) -> int:
    """Where the byte comes first from `place` on, or the end of the data."""
    sought = _LOWS * np.uint64(byte)
    while place + 8 <= len(data):
        differs = eight(data, place) ^ sought
        found = (differs - _LOWS) & ~differs & _HIGHS  # the lowest bit is right, others may be not
        if found:
            return place + _before(found)
        place += 8
    while place < len(data) and data[place] != byte:
        place += 1
    return place


@inlined
def digits(data: Bytes, place: int) -> tuple[int, int]:
    """The number whose digits begin at `place`, right up to 18 of them, and where they end."""
    value, ended = int(np.int64(0)), False
    while not ended and place + 8 <= len(data):
        word = eight(data, place) ^ _ZEROS
        others = ((word + _BEYOND_NINE) | word) & _HIGHS
        if others:
            n = _before(others)
            value = value * TENS[n] + _counted(word << _EIGHT * np.uint64(7 - n) << _EIGHT)
            place += n
            ended = True
        else:
            value = value * 100_000_000 + _counted(word)
            place += 8
    while not ended and place < len(data) and ord("0") <= data[place] <= ord("9"):
        value = 10 * value + (int(data[place]) - ord("0"))
        place += 1
    return value, place


@inlined
def _before(marks: np.uint64) -> int:
    """How many bytes stand before the first that has a mark, its highest bit."""
    lowest = (marks & (~marks + _ONE)) >> _SEVEN
    return int(lowest * _PLACES >> _TOP)


@inlined
def _counted(word: np.uint64) -> int:
    """The number of eight digits, each 0 to 9 in its byte."""
    pairs = (word * np.uint64(10) + (word >> _EIGHT)) & _PAIRS
    fours = (pairs * np.uint64(100) + (pairs >> np.uint64(16))) & _FOURS
    return int((fours * np.uint64(10_000) + (fours >> np.uint64(32))) & np.uint64(0xFFFFFFFF))
