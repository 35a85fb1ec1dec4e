"""A log of a NovAtel receiver, byte for byte: one of the eight messages that hold IMU increments.

    %RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b

RAWIMU and RAWIMUX have the long header, RAWIMUS and RAWIMUSX the short one: week, seconds to the
millisecond. Body: week, seconds to the nanosecond, status, counts of z, −y, x acceleration, then of
z, −y, x rate; with X before them a byte of information and the type of the IMU. Text (A) or binary
(B), little-endian. Checksum over header and body, in text without its first character: CRC-32,
reflected polynomial 0xEDB88320, start 0, not inverted at the end. NovAtel OEM7 Commands and Logs
Reference Manual, "RAWIMU" to "RAWIMUSX", "Message Format", "32-Bit CRC".
"""

import zlib
from dataclasses import dataclass
from itertools import repeat

import numpy as np

from laboratory.arrays import Counts
from laboratory.gps_time import NANOSECONDS, WEEK, week_and_second

NUMBERS = {"RAWIMU": 268, "RAWIMUS": 325, "RAWIMUX": 1461, "RAWIMUSX": 1462}
MESSAGES = tuple(name + form for form in "AB" for name in NUMBERS)

SHORT = b"%%%b,%d,%d.%03d;"
LONG = b"#%b,COM1,0,68.5,FINESTEERING,%d,%d.%03d,024c0040,6125,30019;"
EXTENDED = b"00,%d,"  # information, type
BODY = b"%d,%d.%09d,%b,%d,%d,%d,%d,%d,%d"

SHORT_HEADER = [
    ("sync", "3u1"),
    ("length", "u1"),
    ("number", "<u2"),
    ("week", "<u2"),
    ("ms", "<i4"),
]
LONG_HEADER = [
    ("sync", "3u1"),
    ("header_length", "u1"),
    ("number", "<u2"),
    ("form", "u1"),
    ("port", "u1"),
    ("length", "<u2"),
    ("sequence", "<u2"),
    ("idle", "u1"),
    ("time_status", "u1"),
    ("week", "<u2"),
    ("ms", "<i4"),
    ("receiver_status", "<u4"),
    ("reserved", "<u2"),
    ("version", "<u2"),
]
TIME_FINE = 180  # FINESTEERING
COM1 = 0x20
PLAIN_BODY = [("body_week", "<u4")]
EXTENDED_BODY = [("information", "u1"), ("type", "u1"), ("body_week", "<u2")]
REST = [("seconds", "<f8"), ("status", "<u4"), ("counts", "<6i4")]


@dataclass(frozen=True)
class Samples:
    """What the receiver gets from the IMU: time and counts of n samples."""

    stamps: Counts  # ns since the start of GPS time, (n,): the end of every sample
    accelerometer: Counts  # (n, 3), x y z
    gyro: Counts  # (n, 3), x y z

    @property
    def sent(self) -> Counts:
        """As sent: z, −y, x, the accelerometers first, (n, 6)."""
        signs, order = np.array([1, -1, 1]), [2, 1, 0]
        both = (self.accelerometer, self.gyro)
        return np.hstack([(signs * counts)[:, order] for counts in both])


def checksum(text: bytes) -> int:
    """NovAtel's CRC-32; zlib inverts at both ends, NovAtel at neither."""
    return zlib.crc32(text, 0xFFFFFFFF) ^ 0xFFFFFFFF


def log_bytes(
    samples: Samples, message: str, status: str, line_end: bytes = b"\r\n", imu_type: int = 0
) -> bytes:
    """The whole log.

    `message`: one of MESSAGES; `status`: eight hexadecimal digits; `imu_type`: by NovAtel's list.
    """
    if message.endswith("A"):
        return _text(samples, message, status, line_end, imu_type)
    return _binary(samples, message[:-1], int(status, 16), imu_type)


def _text(samples: Samples, message: str, status: str, line_end: bytes, imu_type: int) -> bytes:
    extended = "X" in message
    header = SHORT if "S" in message.removesuffix("A") else LONG
    line = header + (EXTENDED if extended else b"") + BODY
    fields = [
        repeat(message.encode()),
        *week_and_second(samples.stamps, decimals=3),
        *([repeat(imu_type)] if extended else []),
        *week_and_second(samples.stamps, decimals=9),
        repeat(status.encode("ascii")),
        *samples.sent.T,
    ]
    # Lists, for Python's own integers are formatted four times as fast as numpy's.
    columns = [field.tolist() if isinstance(field, np.ndarray) else field for field in fields]
    lines = []
    for values in zip(*columns, strict=False):
        text = line % values
        lines.append(b"%b*%08x%b" % (text, checksum(text[1:]), line_end))
    return b"".join(lines)


def _binary(samples: Samples, name: str, status: int, imu_type: int) -> bytes:
    extended, short = "X" in name, "S" in name
    header = SHORT_HEADER if short else LONG_HEADER
    body = (EXTENDED_BODY if extended else PLAIN_BODY) + REST
    sent = np.zeros(len(samples.stamps), np.dtype([*header, *body]))
    week, second, ms = week_and_second(samples.stamps, decimals=3)
    sent["sync"] = 0xAA, 0x44, 0x13 if short else 0x12
    sent["number"], sent["length"] = NUMBERS[name], np.dtype(body).itemsize
    sent["week"], sent["ms"] = week, 1000 * second + ms
    if not short:
        sent["header_length"], sent["port"] = np.dtype(header).itemsize, COM1
        sent["time_status"], sent["receiver_status"] = TIME_FINE, 0x024C0040
    weeks, since = np.divmod(samples.stamps, WEEK * NANOSECONDS)
    sent["body_week"], sent["seconds"] = weeks, since / NANOSECONDS
    sent["status"], sent["counts"] = status, samples.sent
    if extended:
        sent["type"] = imu_type
    data, size = sent.tobytes(), sent.dtype.itemsize
    parts = (data[start : start + size] for start in range(0, len(data), size))
    return b"".join(part + checksum(part).to_bytes(4, "little") for part in parts)
