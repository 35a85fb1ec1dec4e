"""The eight messages in which a NovAtel receiver sends the increments of its IMU.

    name        number   text                                      binary body
    RAWIMU      268      #RAWIMUA, long header;    week, seconds,  u32 week, f64 seconds,
    RAWIMUS     325      %RAWIMUSA, short header;  status, counts  u32 status, 6 × i32
    RAWIMUX     1461     #RAWIMUXA, long header;   info, type, and u8 info, u8 type, u16 week, then
    RAWIMUSX    1462     %RAWIMUSXA, short header; the same        the same: 40 bytes either way

    %RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b

Counts: acceleration of z, −y, x, then rate of z, −y, x. Headers: text, long, ten fields after '#',
short, three after '%'; binary, long, 28 bytes from AA 44 12, short, 12 bytes from AA 44 13. All
little-endian, followed by the CRC-32 of header and body; a text's CRC covers the characters between
the first one and the '*'.

Source: NovAtel OEM7 Commands and Logs Reference Manual, "Message Format", "32-Bit CRC", "RAWIMU",
"RAWIMUSX".
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Integers
from inertial.formats.novatel.kernel import (
    BINARY,
    EXTENDED,
    LONG_SYNC,
    SHORT,
    SHORT_SYNC,
    SYNC,
    Bytes,
    scan,
)

MAX_ITEMS = 1 << 16  # of one call
NUMBERS = (268, 325, 1461, 1462)


def name_of(code: int) -> str:
    """The name of an IMU message by its number in `kernel`: RAWIMUSXA."""
    kind = "S" * bool(code & SHORT) + "X" * bool(code & EXTENDED)
    return f"RAWIMU{kind}{'B' if code & BINARY else 'A'}"


def first_bytes(code: int) -> bytes:
    """The first bytes of an IMU message: name, or sync bytes of a binary one."""
    if code & BINARY:
        return bytes([*SYNC, SHORT_SYNC if code & SHORT else LONG_SYNC])
    return (b"%" if code & SHORT else b"#") + name_of(code).encode()


@dataclass(frozen=True)
class Items:
    """n consecutive items of a log; one entry each, (n,)."""

    kind: NDArray[np.int8]  # as in `kernel`
    code: NDArray[np.int32]  # number of an IMU or binary message, or length of a text's name
    start: Integers  # byte where it begins
    length: Integers  # byte
    stamp: Integers  # of IMU messages, ns since the start of GPS time
    status: NDArray[np.uint32]
    counts: NDArray[np.int32]  # as sent, (n, 6)
    imu_type: NDArray[np.int16]  # −1 where the message does not state it
    end: int  # the byte after the last item


def find_items(data: Bytes, start: int, *, last: bool) -> Items:
    """The items of `data` from `start` on; `last`: no data follow in the file."""
    data = data.view()
    data.flags.writeable = False  # so that the kernel is compiled for one type of array
    kind, code = np.empty(MAX_ITEMS, np.int8), np.empty(MAX_ITEMS, np.int32)
    bounds, stamp = np.empty(MAX_ITEMS + 1, np.int64), np.empty(MAX_ITEMS, np.int64)
    status, imu_type = np.empty(MAX_ITEMS, np.uint32), np.empty(MAX_ITEMS, np.int16)
    counts = np.empty((MAX_ITEMS, 6), np.int32, order="F")  # used by columns
    n = scan(data, start, last, kind, code, bounds, stamp, status, counts, imu_type)
    return Items(
        kind[:n],
        code[:n],
        bounds[:n],
        np.diff(bounds[: n + 1]),
        stamp[:n],
        status[:n],
        counts[:n],
        imu_type[:n],
        int(bounds[n]),
    )
