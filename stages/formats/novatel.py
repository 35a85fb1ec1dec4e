"""A text log of a NovAtel receiver: RAWIMUSA lines, the increments of the IMU in counts.

    %RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873*3928684b

Header: week, seconds to the millisecond. Body: GPS week, seconds of the week to the nanosecond,
status word (hexadecimal), six counts: acceleration of z, −y, x, then rate of z, −y, x (the count
sizes and what stands for which axis belong to the instrument, not to this format). Every line,
whatever its message, ends with '*' and the checksum of what stands between its first character
and the '*': CRC-32 with reflected polynomial 0xEDB88320, start 0, not inverted at the end, as eight
hexadecimal digits in lower case. No line is used whose checksum is not right.

Source: NovAtel OEM6 Family Firmware Reference Manual (OM-20000129), "RAWIMUS", "32-Bit CRC".
"""

import re
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from pyarrow import csv

from stages.formats.account import (
    BLANK,
    DECODED,
    OTHER_MESSAGE,
    REFUSED,
    Account,
    RefusedLine,
    quoted,
    refused_line,
)
from stages.formats.arrow_arrays import numbers_of
from stages.formats.gps_time import NANOSECONDS, WEEK
from stages.formats.pieces import LONGEST_LINE, PIECE_BYTES, Integers, Piece, pieces

MESSAGE = "RAWIMUSA"
LAST_WEEK = 9999  # the year 2171: what claims a later one is no week

_PREFIX = b"%" + MESSAGE.encode()
_DIGITS = 8  # of the checksum
_CHECKED = len("%") + len("*") + _DIGITS  # characters of a line outside its checksum
_ONES = 0xFFFFFFFF
_HEXADECIMAL = re.compile("[0-9a-fA-F]{1,8}")
_COUNTS = tuple(f"{sensor} {place}" for sensor in ("accelerometer", "gyro") for place in "123")
_COLUMNS = ("message", "header week", "header seconds", "week", "seconds", "status", *_COUNTS)
_TYPES = {
    "week": pa.int32(),
    "seconds": pa.float64(),
    "status": pa.dictionary(pa.int32(), pa.string()),
    **dict.fromkeys(_COUNTS, pa.int32()),
}
_COMMAS = bytes.maketrans(b";*", b",,")  # header, body and checksum become fields like the others
_NO_DIGIT = 255
_DIGIT = np.full(256, _NO_DIGIT, np.uint8)
_DIGIT[list(b"0123456789abcdef")] = range(16)


@dataclass(frozen=True)
class Increments:
    """What n RAWIMUSA lines say."""

    record: Integers  # number among the RAWIMUSA lines of the log, refused ones counted, (n,)
    offset: Integers  # byte in the file where the line begins, (n,)
    line: Integers  # number of the line, from 1, (n,)
    stamp: Integers  # ns since the start of GPS time, (n,)
    status: NDArray[np.uint32]  # (n,)
    counts: NDArray[np.int32]  # as sent: accelerometer z, −y, x, gyro z, −y, x; (n, 6)


@dataclass(frozen=True)
class Reading:
    """What a piece of the log holds."""

    records: Increments
    refused: list[RefusedLine]
    account: Account


@dataclass(frozen=True)
class _Fields:
    """The fields of lines in which everything can be read."""

    stamp: Integers
    status: NDArray[np.uint32]
    counts: NDArray[np.int32]


def read(path: Path, piece_bytes: int = PIECE_BYTES) -> Iterator[Reading]:
    """The log at `path`, piece by piece."""
    records = 0
    for piece in pieces(path, piece_bytes):
        reading, more = _read_piece(piece, records)
        records += more
        yield reading


def checksum(text: bytes) -> int:
    """NovAtel's CRC-32 of what stands between the first character of a line and its '*'."""
    return zlib.crc32(text, _ONES) ^ _ONES  # zlib inverts at both ends, NovAtel at neither


def _read_piece(piece: Piece, records: int) -> tuple[Reading, int]:
    """What `piece` holds, `records` records being before it, and how many it counts itself."""
    right = _right_checksums(piece)
    named, ours = _rawimusa_lines(piece)
    ours &= right
    reasons: dict[int, str] = {}

    fields = _read_at_once(piece, ours)
    if fields is None:
        fields, reasons = _read_one_by_one(piece, ours)

    account = Account()
    for index in np.flatnonzero(~right).tolist():
        if reason := _why_refused(piece, index):
            reasons[index] = reason
        else:
            account.add(BLANK, "", 1, int(piece.lengths[index]))
    for name, (lines, size) in _other_messages(piece, right & ~ours).items():
        account.add(OTHER_MESSAGE, name, lines, size)
    lost = np.array(sorted(reasons), np.int64)
    counted = ours | (named & ~right)
    ours[lost] = False
    account.add_all(DECODED, MESSAGE, piece.lengths[ours])
    account.add_all(REFUSED, "", piece.lengths[lost])

    number = records + np.cumsum(counted) - 1
    increments = Increments(
        number[ours],
        piece.offsets[ours],
        piece.lines[ours],
        fields.stamp,
        fields.status,
        fields.counts,
    )
    refused = [refused_line(piece, index, reasons[index]) for index in lost.tolist()]
    return Reading(increments, refused, account), int(counted.sum())


# ---- which lines are whole


def _right_checksums(piece: Piece) -> NDArray[np.bool_]:
    """Which lines of `piece` begin as a message does and end with the checksum of their text."""
    characters = np.frombuffer(piece.data, np.uint8)
    first = characters[piece.starts]
    tail = np.take(characters, piece.ends[:, np.newaxis] + np.arange(-1 - _DIGITS, 0), mode="clip")
    digits = _DIGIT[tail[:, 1:]]
    stated = digits.astype(np.int64) @ (16 ** np.arange(_DIGITS - 1, -1, -1))
    right: NDArray[np.bool_] = (
        ((first == ord("%")) | (first == ord("#")))
        & (piece.ends - piece.starts >= _CHECKED)
        & (piece.lengths <= LONGEST_LINE)
        & (tail[:, 0] == ord("*"))
        & (digits != _NO_DIGIT).all(axis=1)
    )
    text, crc32 = piece.data, zlib.crc32
    begins = (piece.starts[right] + 1).tolist()
    stops = (piece.ends[right] - 1 - _DIGITS).tolist()
    computed = [crc32(text[a:b], _ONES) for a, b in zip(begins, stops, strict=True)]
    right[right] = (np.array(computed, np.int64) ^ _ONES) == stated[right]
    return right


def _rawimusa_lines(piece: Piece) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which lines begin with %RAWIMUSA, and in which of them that is the whole name."""
    characters = np.frombuffer(piece.data, np.uint8)
    places = piece.starts[:, np.newaxis] + np.arange(len(_PREFIX) + 1)
    head = np.take(characters, places, mode="clip")
    long_enough = piece.ends - piece.starts >= len(_PREFIX)
    named = long_enough & (head[:, :-1] == np.frombuffer(_PREFIX, np.uint8)).all(axis=1)
    return named, named & (head[:, -1] == ord(","))


def _why_refused(piece: Piece, index: int) -> str:
    """Why a line without right checksum cannot be used; empty for a blank line."""
    text = piece.text(index)
    if piece.lengths[index] > LONGEST_LINE:
        return f"{piece.lengths[index]} bytes without a line end, expected at most {LONGEST_LINE}"
    if not text.strip():
        return ""
    if text[:1] not in (b"%", b"#"):
        return f"begins with '{quoted(text[:1])}', expected '%' or '#'"
    body, star, stated = text[1:].partition(b"*")
    if not star:
        return f"no checksum, expected '*' and {_DIGITS} hexadecimal digits at the end"
    return f"checksum '{quoted(stated)}', computed '{checksum(body):08x}'"


def _other_messages(piece: Piece, others: NDArray[np.bool_]) -> dict[str, tuple[int, int]]:
    """Number of lines and bytes of each other message."""
    lines: Counter[str] = Counter()
    sizes: Counter[str] = Counter()
    for index in np.flatnonzero(others).tolist():
        name = quoted(re.split(rb"[,;*]", piece.text(index)[1:], maxsplit=1)[0])
        lines[name] += 1
        sizes[name] += int(piece.lengths[index])
    return {name: (lines[name], sizes[name]) for name in lines}


# ---- what their fields say


def _read_at_once(piece: Piece, lines: NDArray[np.bool_]) -> _Fields | None:
    """The fields of all `lines` of the piece, or None where one of them cannot be read."""
    if not lines.any():
        return _fields([], [], [], [])
    text = piece.data
    if not lines.all():
        stops = piece.starts + piece.lengths
        picked = zip(piece.starts[lines].tolist(), stops[lines].tolist(), strict=True)
        text = b"".join([text[start:stop] for start, stop in picked])
    try:
        table = csv.read_csv(
            pa.BufferReader(text.translate(_COMMAS)),
            csv.ReadOptions(column_names=[*_COLUMNS, "checksum"], block_size=2 * LONGEST_LINE),
            csv.ParseOptions(quote_char=False, double_quote=False),
            csv.ConvertOptions(column_types=_TYPES, include_columns=list(_TYPES), null_values=[]),
        )
    except pa.ArrowInvalid:
        return None
    if len(table) != np.count_nonzero(lines):
        return None
    status = table["status"].unify_dictionaries().combine_chunks()
    words = status.dictionary.to_pylist()
    week, seconds = numbers_of(table["week"]), numbers_of(table["seconds"])
    if (
        not all(_HEXADECIMAL.fullmatch(word) for word in words)
        or not ((week >= 0) & (week <= LAST_WEEK)).all()
        or not ((seconds >= 0) & (seconds < WEEK)).all()
    ):
        return None
    values = np.array([int(word, 16) for word in words], np.uint32)
    counts = np.column_stack([numbers_of(table[name]) for name in _COUNTS])
    return _fields(week, seconds, values[np.from_dlpack(status.indices)], counts)


def _read_one_by_one(piece: Piece, lines: NDArray[np.bool_]) -> tuple[_Fields, dict[int, str]]:
    """The fields of those `lines` that can be read, and why each of the others cannot."""
    rows: list[tuple[int, float, int, list[int]]] = []
    reasons = {}
    for index in np.flatnonzero(lines).tolist():
        try:
            rows.append(_read_line(piece.text(index)))
        except ValueError as error:
            reasons[index] = f"right checksum, but {error}"
    week, seconds, status, counts = zip(*rows, strict=True) if rows else ([], [], [], [])
    return _fields(week, seconds, status, counts), reasons


def _read_line(text: bytes) -> tuple[int, float, int, list[int]]:
    """Week, seconds, status and the six counts of a RAWIMUSA line.

    Raises
    ------
    ValueError
        where a field is missing or cannot be read, with the field and what was expected
    """
    values = text.translate(_COMMAS).decode("ascii", "backslashreplace").split(",")[:-1]
    if len(values) != len(_COLUMNS):
        raise ValueError(f"{len(values)} fields, expected {len(_COLUMNS)}")
    fields = dict(zip(_COLUMNS, values, strict=True))
    week = _number(fields, "week", int, 0, LAST_WEEK)
    seconds = _number(fields, "seconds", float, 0, WEEK)
    if seconds == WEEK:
        raise ValueError(f"seconds is {WEEK}, expected the next week")
    if not _HEXADECIMAL.fullmatch(fields["status"]):
        raise ValueError(f"status is '{fields['status']}', expected up to 8 hexadecimal digits")
    counts = [int(_number(fields, name, int, -(2**31), 2**31 - 1)) for name in _COUNTS]
    return int(week), seconds, int(fields["status"], 16), counts


def _number(
    fields: dict[str, str], name: str, kind: type[int] | type[float], least: int, most: int
) -> float:
    """The value of the field `name`, which must lie between `least` and `most`."""
    what = "a whole number" if kind is int else "a number"
    expected = f"{name} is '{fields[name]}', expected {what} from {least} to {most}"
    try:
        value = kind(fields[name])
    except ValueError:
        raise ValueError(expected) from None
    if not least <= value <= most:
        raise ValueError(expected)
    return value


def _fields(week: object, seconds: object, status: object, counts: object) -> _Fields:
    """The fields as arrays; time as whole nanoseconds, for a double would lose them."""
    whole = np.asarray(week, np.int64) * (WEEK * NANOSECONDS)
    part = np.rint(np.asarray(seconds, np.float64) * NANOSECONDS).astype(np.int64)
    return _Fields(
        whole + part,
        np.asarray(status, np.uint32),
        np.asarray(counts, np.int32).reshape(-1, len(_COUNTS)),
    )
