"""A log of RAWIMUSA lines, byte for byte as a NovAtel receiver writes it.

    %RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b

Header: week, seconds to the millisecond. Body: week, seconds to the nanosecond, status, counts of
z, −y, x acceleration, then of z, −y, x rate. Checksum over all between % and *: CRC-32, reflected
polynomial 0xEDB88320, start 0, not inverted at the end. NovAtel OEM6 Family Firmware Reference
Manual, "RAWIMUS" and "32-Bit CRC".
"""

import zlib
from dataclasses import dataclass
from itertools import repeat

import numpy as np

from laboratory.arrays import Counts
from laboratory.gps_time import week_and_second

LINE = b"RAWIMUSA,%d,%d.%03d;%d,%d.%09d,%b,%d,%d,%d,%d,%d,%d"


@dataclass(frozen=True)
class Samples:
    """What the receiver has got from the IMU: time and counts of n samples."""

    stamps: Counts  # ns since the start of GPS time, (n,): the end of every sample
    accelerometer: Counts  # (n, 3), x y z
    gyro: Counts  # (n, 3), x y z


def checksum(text: bytes) -> int:
    """NovAtel's CRC-32 of a line; zlib inverts at both ends, NovAtel at neither."""
    return zlib.crc32(text, 0xFFFFFFFF) ^ 0xFFFFFFFF


def log_bytes(samples: Samples, status: str, line_end: bytes) -> bytes:
    """The whole log."""
    signs, order = np.array([1, -1, 1]), [2, 1, 0]  # of x y z: sent as z, −y, x
    fields = [
        *week_and_second(samples.stamps, decimals=3),
        *week_and_second(samples.stamps, decimals=9),
        repeat(status.encode("ascii")),
        *(signs * samples.accelerometer)[:, order].T,
        *(signs * samples.gyro)[:, order].T,
    ]
    # Lists, for Python's own integers are formatted four times as fast as numpy's.
    columns = [field.tolist() if isinstance(field, np.ndarray) else field for field in fields]
    lines = []
    for values in zip(*columns, strict=False):
        text = LINE % values
        lines.append(b"%%%b*%08x%b" % (text, checksum(text), line_end))
    return b"".join(lines)
