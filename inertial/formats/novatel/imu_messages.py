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

from inertial.formats.novatel.kernel import (
    BINARY,
    BODY_BYTES,
    CRC_BYTES,
    EXTENDED,
    IMU,
    LAST_WEEK,
    LONG_SYNC,
    SECOND_NS,
    SHORT,
    SHORT_SYNC,
    SYNC,
    UNPARSED,
    WEEK_S,
    Bytes,
    Integers,
    scan,
)

MAX_ITEMS = 1 << 16  # of one call
NUMBERS = (268, 325, 1461, 1462)

_BODY = np.dtype(
    {
        "names": ["week", "imu_type", "extended_week", "seconds", "status", "counts"],
        "formats": ["<u4", "u1", "<u2", "<f8", "<u4", "(6,)<i4"],
        "offsets": [0, 1, 2, 4, 12, 16],
        "itemsize": BODY_BYTES,
    }
)


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
    items = Items(
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
    _read_bodies(data, items)
    return items


def _read_bodies(data: Bytes, items: Items) -> None:
    """Fill in the fields of the binary IMU messages; those without a valid time are UNPARSED."""
    binary = (items.kind == IMU) & (items.code >= BINARY)
    if not binary.any():
        return
    some = slice(None) if binary.all() else np.flatnonzero(binary)
    ends = items.start[some] + items.length[some] - CRC_BYTES
    # A body may begin at any byte: as many overlapping views of the data, of which some are used.
    bodies = np.ndarray(len(data) - BODY_BYTES + 1, _BODY, data, strides=(1,))
    body = bodies[ends - BODY_BYTES]
    extended = (items.code[some] & EXTENDED) != 0
    week = np.where(extended, body["extended_week"], body["week"]).astype(np.int64)
    seconds = body["seconds"]
    valid = (week <= LAST_WEEK) & (seconds < WEEK_S) & ~np.signbit(seconds)  # no NaN is smaller
    seconds = np.where(valid, seconds, 0.0)
    whole = np.floor(seconds)
    ns = np.rint((seconds - whole) * SECOND_NS).astype(np.int64)
    items.stamp[some] = (week * WEEK_S + whole.astype(np.int64)) * SECOND_NS + ns
    items.status[some] = body["status"]
    items.counts[some] = body["counts"]
    items.imu_type[some] = np.where(extended, body["imu_type"].astype(np.int16), -1)
    items.kind[some] = np.where(valid, IMU, UNPARSED)
