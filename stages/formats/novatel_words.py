"""Why a message of a NovAtel log is not used; what it says where only a second look can tell."""

import re
import struct
from dataclasses import dataclass

from stages.formats.account import quoted
from stages.formats.crc32 import checksum
from stages.formats.gps_time import NANOSECONDS, WEEK
from stages.formats.novatel_items import LAST_WEEK
from stages.formats.novatel_messages import (
    BODY_BYTES,
    CRC_BYTES,
    IMU_MESSAGES,
    LONG_BYTES,
    LONG_FIELDS,
    LONG_SYNC,
    SHORT_BYTES,
    SHORT_FIELDS,
    SHORT_SYNC,
    SYNC,
)
from stages.formats.novatel_text import DIGITS
from stages.formats.pieces import LONGEST_LINE

_HEXADECIMAL = re.compile("[0-9a-fA-F]{1,8}")
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)  # no 1_000
_COUNTS = tuple(f"{sensor} {place}" for sensor in ("accelerometer", "gyro") for place in "123")


@dataclass(frozen=True)
class Fields:
    """What one message says: stamp, ns since the start of GPS time; six counts; type of the IMU."""

    stamp: int
    status: int
    counts: list[int]
    imu: int


def why_refused(text: bytes) -> str:
    """Why bytes that are no message are none."""
    line = text.rstrip(b"\r\n")
    if len(text) > LONGEST_LINE:
        return f"{len(text)} bytes without a line end, expected at most {LONGEST_LINE}"
    if text[:2] == bytes(SYNC) and text[2:3] in (bytes([LONG_SYNC]), bytes([SHORT_SYNC])):
        return _why_no_binary(text)
    if text[:1] not in (b"%", b"#"):
        begins = quoted(text[:1])
        return f"begins with '{begins}', expected '%', '#' or a binary message's AA 44"
    body, star, stated = line[1:].partition(b"*")
    if not star:
        return f"no checksum, expected '*' and {DIGITS} hexadecimal digits at the end"
    return f"checksum '{quoted(stated)}', computed '{checksum(body):08x}'"


def _why_no_binary(text: bytes) -> str:
    long = text[2] == LONG_SYNC
    if len(text) < SHORT_BYTES:
        return f"{len(text)} bytes of a binary message, too few for its header"
    header = text[3] if long else SHORT_BYTES
    if header != (LONG_BYTES if long else SHORT_BYTES):
        return f"a binary message with a header of {header} bytes, expected {LONG_BYTES}"
    body = int.from_bytes(text[8:10], "little") if long else text[3]
    number = int.from_bytes(text[4:6], "little")
    total = header + body + CRC_BYTES
    if len(text) != total:
        return f"{len(text)} bytes of binary message {number}, by its header it has {total}"
    stated = int.from_bytes(text[-CRC_BYTES:], "little")
    computed = checksum(text[:-CRC_BYTES])
    return f"binary message {number}: checksum '{stated:08x}', computed '{computed:08x}'"


def why_unsure(text: bytes) -> str:
    """Why a message of the IMU with the right checksum cannot be read."""
    try:
        _read(text)
    except ValueError as error:
        return f"right checksum, but {error}"
    raise AssertionError(f"{quoted(text)} can be read")


def fields_of(text: bytes) -> Fields | None:
    """What a message of the IMU with the right checksum says; None where it cannot be read."""
    try:
        return _read(text)
    except ValueError:
        return None


def _read(text: bytes) -> Fields:
    """What a message says.

    Raises
    ------
    ValueError
        where a field is missing or cannot be read, with the field and what was expected
    """
    return _read_binary(text) if text[:2] == bytes(SYNC) else _read_text(text)


def _read_binary(text: bytes) -> Fields:
    header = LONG_BYTES if text[2] == LONG_SYNC else SHORT_BYTES
    body = text[header:-CRC_BYTES]
    if len(body) != BODY_BYTES:
        raise ValueError(f"a body of {len(body)} bytes, expected {BODY_BYTES}")
    number = int.from_bytes(text[4:6], "little")
    extended = next(m.extended for m in IMU_MESSAGES if m.number == number)
    week = int.from_bytes(body[2:4] if extended else body[:4], "little")
    (seconds,) = struct.unpack_from("<d", body, 4)
    raise ValueError(
        f"week {week}, seconds {seconds!r}, expected up to {LAST_WEEK} and from 0 to {WEEK}"
    )


def _read_text(text: bytes) -> Fields:
    told = text[1:].partition(b"*")[0].decode("ascii", "backslashreplace")
    header, body = (part.split(",") for part in told.partition(";")[::2])
    message = next(message for message in IMU_MESSAGES if message.name == header[0])
    expected = SHORT_FIELDS if message.short else LONG_FIELDS
    if len(header) != expected:
        raise ValueError(f"{len(header)} fields before the ';', expected {expected}")
    extended = ("information", "type") if message.extended else ()
    columns = (*extended, "week", "seconds", "status", *_COUNTS)
    if len(body) != len(columns):
        raise ValueError(f"{len(body)} fields behind the ';', expected {len(columns)}")
    fields = dict(zip(columns, body, strict=True))
    imu = int(_number(fields, "type", int, 0, 255)) if message.extended else -1
    week = int(_number(fields, "week", int, 0, LAST_WEEK))
    seconds = _number(fields, "seconds", float, 0, WEEK)
    if seconds == WEEK:
        raise ValueError(f"seconds is {WEEK}, expected the next week")
    if not _HEXADECIMAL.fullmatch(fields["status"]):
        raise ValueError(f"status is '{fields['status']}', expected up to 8 hexadecimal digits")
    counts = [int(_number(fields, name, int, -(2**31), 2**31 - 1)) for name in _COUNTS]
    stamp = week * WEEK * NANOSECONDS + round(seconds * NANOSECONDS)
    return Fields(stamp, int(fields["status"], 16), counts, imu)


def _number(
    fields: dict[str, str], name: str, kind: type[int] | type[float], least: int, most: int
) -> float:
    """The value of the field `name`, which must lie between `least` and `most`."""
    what = "a whole number" if kind is int else "a number"
    expected = (
        f"{name} is '{quoted(fields[name].encode())}', expected {what} from {least} to {most}"
    )
    if not _NUMBER.fullmatch(fields[name]):
        raise ValueError(expected)
    try:
        value = kind(fields[name])
    except ValueError:
        raise ValueError(expected) from None
    if not least <= value <= most:
        raise ValueError(expected)
    return value
