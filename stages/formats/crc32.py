"""NovAtel's CRC-32: reflected polynomial 0xEDB88320, start 0, not inverted at the end.

Source: NovAtel OEM6 Family Firmware Reference Manual (OM-20000129), "32-Bit CRC"; eight bytes at
a time after Kounavis and Berry, "Novel Table Lookup-Based Algorithms for High-Performance CRC
Generation", IEEE Transactions on Computers 57 (2008).
"""

import zlib

import numpy as np
from numpy.typing import NDArray

from stages.formats.compiled import compiled, inlined
from stages.formats.little_endian import four
from stages.formats.novatel_items import Bytes

POLYNOMIAL = 0xEDB88320
_ONES = 0xFFFFFFFF


def checksum(text: bytes) -> int:
    """The checksum of some bytes; zlib inverts at both ends, NovAtel at neither."""
    return zlib.crc32(text, _ONES) ^ _ONES


def _tables() -> NDArray[np.uint32]:
    """What a byte does to the checksum when k more bytes follow, (8, 256)."""
    tables = np.zeros((8, 256), np.uint32)
    for byte in range(256):
        value = byte
        for _ in range(8):
            value = value >> 1 ^ (POLYNOMIAL if value & 1 else 0)
        tables[0, byte] = value
    for k in range(1, 8):
        tables[k] = tables[k - 1] >> 8 ^ tables[0][tables[k - 1] & 0xFF]
    return tables


_TABLES = _tables()
_LOW, _EIGHT, _SIXTEEN, _TOP = np.uint32(0xFF), np.uint32(8), np.uint32(16), np.uint32(24)


@compiled
def crc32(data: Bytes, first: int, after: int) -> np.uint32:
    """The checksum of data[first:after]."""
    if first < 0:
        return np.uint32(0)
    crc = np.uint32(0)
    place = first
    while place + 8 <= after:
        crc = _followed(four(data, place) ^ crc, 4) ^ _followed(four(data, place + 4), 0)
        place += 8
    if place + 4 <= after:
        crc = _followed(four(data, place) ^ crc, 0)
        place += 4
    while place < after:
        crc = _TABLES[0, (crc ^ np.uint32(data[place])) & _LOW] ^ crc >> _EIGHT
        place += 1
    return crc


@inlined
def _followed(word: np.uint32, k: int) -> np.uint32:
    """What four bytes do to the checksum when k more follow."""
    first = _TABLES[k + 3, word & _LOW] ^ _TABLES[k + 2, word >> _EIGHT & _LOW]
    second = _TABLES[k + 1, word >> _SIXTEEN & _LOW] ^ _TABLES[k, word >> _TOP]
    return np.uint32(first ^ second)
