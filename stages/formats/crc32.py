"""NovAtel's CRC-32: reflected polynomial 0xEDB88320, start 0, not inverted at the end.

Source: NovAtel OEM6 Family Firmware Reference Manual (OM-20000129), "32-Bit CRC"; eight bytes at
a time after Kounavis and Berry, "Novel Table Lookup-Based Algorithms for High-Performance CRC
Generation", IEEE Transactions on Computers 57 (2008).
"""

import zlib

import numpy as np
from numpy.typing import NDArray

from stages.formats.compiled import compiled

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


@compiled
def crc32(data: NDArray[np.uint8], first: int, after: int) -> np.uint32:
    """The checksum of data[first:after]."""
    if first < 0:
        return np.uint32(0)
    low, eight, sixteen = np.uint32(0xFF), np.uint32(8), np.uint32(16)
    crc = np.uint32(0)
    place = first
    while place + 8 <= after:
        crc ^= (
            np.uint32(data[place])
            | np.uint32(data[place + 1]) << eight
            | np.uint32(data[place + 2]) << sixteen
            | np.uint32(data[place + 3]) << np.uint32(24)
        )
        crc = (
            _TABLES[7, crc & low]
            ^ _TABLES[6, crc >> eight & low]
            ^ _TABLES[5, crc >> sixteen & low]
            ^ _TABLES[4, crc >> np.uint32(24)]
            ^ _TABLES[3, data[place + 4]]
            ^ _TABLES[2, data[place + 5]]
            ^ _TABLES[1, data[place + 6]]
            ^ _TABLES[0, data[place + 7]]
        )
        place += 8
    while place < after:
        crc = _TABLES[0, (crc ^ np.uint32(data[place])) & low] ^ crc >> eight
        place += 1
    return crc
