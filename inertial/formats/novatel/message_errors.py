"""Why a message of a NovAtel log is refused; the fields of one in unusual notation."""

import re
import struct
import zlib
from dataclasses import dataclass

from inertial.formats.account import quoted
from inertial.formats.novatel.imu_messages import NUMBERS
from inertial.formats.novatel.kernel import (
    BINARY,
    BODY_BYTES,
    CRC_BYTES,
    CRC_DIGITS,
    EXTENDED,
    LAST_WEEK,
    LONG_BYTES,
    LONG_FIELDS,
    LONG_SYNC,
    MAX_LINE_BYTES,
    SECOND_NS,
    SHORT,
    SHORT_BYTES,
    SHORT_FIELDS,
    SHORT_SYNC,
    SYNC,
    WEEK_S,
)
from inertial.text.messages import _

_ONES = 0xFFFFFFFF
_HEXADECIMAL = re.compile("[0-9a-fA-F]{1,8}")
_NUMBER = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*", re.ASCII)  # no 1_000
_COUNTS = tuple(f"{sensor} {place}" for sensor in ("accelerometer", "gyro") for place in "123")


@dataclass(frozen=True)
class Fields:
    """The fields of a message: stamp, ns since the start of GPS time; six counts; type of IMU."""

    stamp: int
    status: int
    counts: list[int]
    imu_type: int


def checksum(text: bytes) -> int:
    """The checksum of some bytes; zlib inverts at both ends, NovAtel at neither."""
    return zlib.crc32(text, _ONES) ^ _ONES


def too_long(size: int) -> str:
    """Why a stretch without a line end is refused."""
    return _(
        "{size} bytes without a line end, expected at most {max_line_bytes}",
        size=size,
        max_line_bytes=MAX_LINE_BYTES,
    )


def why_refused(text: bytes) -> str:
    """Why bytes are no message."""
    line = text.rstrip(b"\r\n")
    if len(text) > MAX_LINE_BYTES:
        return too_long(len(text))
    if text[:2] == bytes(SYNC) and text[2:3] in (bytes([LONG_SYNC]), bytes([SHORT_SYNC])):
        return _why_not_binary(text)
    if text[:1] not in (b"%", b"#"):
        begins = quoted(text[:1])
        return _(
            "begins with '{begins}', expected '%', '#' or a binary message's AA 44", begins=begins
        )
    body, star, stated = line[1:].partition(b"*")
    if not star:
        return _(
            "no checksum, expected '*' and {crc_digits} hexadecimal digits at the end",
            crc_digits=CRC_DIGITS,
        )
    return _(
        "checksum '{stated}', computed '{body:08x}'", stated=quoted(stated), body=checksum(body)
    )


def _why_not_binary(text: bytes) -> str:
    long = text[2] == LONG_SYNC
    if len(text) < SHORT_BYTES:
        return _("{text} bytes of a binary message, too few for its header", text=len(text))
    header = text[3] if long else SHORT_BYTES
    if header != (LONG_BYTES if long else SHORT_BYTES):
        return _(
            "a binary message with a header of {header} bytes, expected {long_bytes}",
            header=header,
            long_bytes=LONG_BYTES,
        )
    body = int.from_bytes(text[8:10], "little") if long else text[3]
    number = int.from_bytes(text[4:6], "little")
    total = header + body + CRC_BYTES
    if len(text) != total:
        return _(
            "{text} bytes of binary message {number}, by its header it has {total}",
            text=len(text),
            number=number,
            total=total,
        )
    stated = int.from_bytes(text[-CRC_BYTES:], "little")
    computed = checksum(text[:-CRC_BYTES])
    return _(
        "binary message {number}: checksum '{stated:08x}', computed '{computed:08x}'",
        number=number,
        stated=stated,
        computed=computed,
    )


def fields_of(text: bytes, code: int) -> Fields:
    """The fields of IMU message number `code` that the kernel did not parse.

    Raises
    ------
    ValueError
        where a field is missing or invalid, with the field and the expected values
    """
    if code & BINARY:
        raise ValueError(_why_no_fields(text))
    content = text[1:].partition(b"*")[0].decode("ascii", "backslashreplace")
    header, body = (part.split(",") for part in content.partition(";")[::2])
    expected = SHORT_FIELDS if code & SHORT else LONG_FIELDS
    if len(header) != expected:
        raise ValueError(f"{len(header)} fields before the ';', expected {expected}")
    extended = ("information", "type") if code & EXTENDED else ()
    names = (*extended, "week", "seconds", "status", *_COUNTS)
    if len(body) != len(names):
        raise ValueError(f"{len(body)} fields behind the ';', expected {len(names)}")
    fields = dict(zip(names, body, strict=True))
    imu_type = int(_number(fields, "type", int, 0, 255)) if extended else -1
    week = int(_number(fields, "week", int, 0, LAST_WEEK))
    seconds = _number(fields, "seconds", float, 0, WEEK_S)
    if seconds == WEEK_S:
        raise ValueError(f"seconds is {WEEK_S}, expected the next week")
    if not _HEXADECIMAL.fullmatch(fields["status"]):
        raise ValueError(f"status is '{fields['status']}', expected up to 8 hexadecimal digits")
    counts = [int(_number(fields, name, int, -(2**31), 2**31 - 1)) for name in _COUNTS]
    stamp = week * WEEK_S * SECOND_NS + round(seconds * SECOND_NS)
    return Fields(stamp, int(fields["status"], 16), counts, imu_type)


def _why_no_fields(text: bytes) -> str:
    """Why the fields of a binary IMU message are invalid."""
    body = text[LONG_BYTES if text[2] == LONG_SYNC else SHORT_BYTES : -CRC_BYTES]
    if len(body) != BODY_BYTES:
        return _(
            "a body of {body} bytes, expected {body_bytes}", body=len(body), body_bytes=BODY_BYTES
        )
    extended = int.from_bytes(text[4:6], "little") in NUMBERS[2:]
    week = int.from_bytes(body[2:4] if extended else body[:4], "little")
    (seconds,) = struct.unpack_from("<d", body, 4)
    return _(
        "week {week}, seconds {seconds!r}, expected up to {last_week} and from 0 to {week_s}",
        week=week,
        seconds=seconds,
        last_week=LAST_WEEK,
        week_s=WEEK_S,
    )


def _number(
    fields: dict[str, str], name: str, kind: type[int] | type[float], least: int, most: int
) -> float:
    """The value of the field `name`, which must lie between `least` and `most`."""
    noun = "a whole number" if kind is int else "a number"
    expected = _(
        "{name} is '{quoted}', expected {noun} from {least} to {most}",
        name=name,
        quoted=quoted(fields[name].encode()),
        noun=noun,
        least=least,
        most=most,
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
