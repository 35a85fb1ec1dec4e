"""Reader of a NovAtel log: the increments of the IMU among any other messages, text and binary.

The first IMU messages decide which of the eight is read; a receiver may send the same samples as
several, and the others count as other messages. No message is used whose checksum is wrong. Axes
and size of a count belong to the instrument, not to this format.

A receiver that counts weeks in ten bits begins again after week 1023; within a log weeks go on.
"""

from collections import Counter
from collections.abc import Generator, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Booleans, Integers
from inertial.formats.account import (
    BLANK,
    DECODED,
    OTHER_MESSAGE,
    REFUSED,
    Account,
    RefusedLine,
    quoted,
)
from inertial.formats.novatel import kernel
from inertial.formats.novatel.imu_messages import (
    NUMBERS,
    Items,
    find_items,
    first_bytes,
    name_of,
)
from inertial.formats.novatel.kernel import BINARY, IMU, UNPARSED, Bytes
from inertial.formats.novatel.message_errors import fields_of, too_long, why_refused
from inertial.text.messages import _

CHUNK_BYTES = 7 << 19  # of the shortest IMU messages as many as rows of a batch
WEEK_NS = kernel.WEEK_S * kernel.SECOND_NS
ROLLOVER_NS = 1024 * WEEK_NS  # the weeks that ten bits count


@dataclass(frozen=True)
class Increments:
    """The contents of n IMU messages."""

    record: Integers  # number among the IMU's messages of the log, with refused ones, (n,)
    offset: Integers  # byte in the file where the message begins, (n,)
    line: Integers  # number of the line or binary message, from 1, (n,)
    stamp: Integers  # ns since the start of GPS time, (n,)
    status: NDArray[np.uint32]  # (n,)
    counts: NDArray[np.int32]  # as sent: accelerometer z, −y, x, gyro z, −y, x; (n, 6)
    imu: NDArray[np.int16]  # type of the IMU, −1 where the message does not state it, (n,)


@dataclass(frozen=True)
class Reading:
    """The contents of a chunk of the log."""

    records: Increments
    refused: list[RefusedLine]
    account: Account


def read(path: Path, chunk_bytes: int = CHUNK_BYTES) -> Iterator[Reading]:
    """The log at `path`, chunk by chunk."""
    log = _Log()
    buffer, held = np.empty(2 * chunk_bytes, np.uint8), 0
    with path.open("rb") as file:
        while size := file.readinto(buffer.data[held : held + chunk_bytes]):
            held += size
            consumed = yield from _readings(log, buffer[:held], last=False)
            rest = buffer[consumed:held]
            if len(rest) + chunk_bytes > len(buffer):
                buffer = np.empty(2 * len(buffer), np.uint8)
            held = len(rest)
            buffer[:held] = rest
    yield from _readings(log, buffer[:held], last=True)
    if log.continued is not None:
        account = Account()
        account.add(REFUSED, "", 1, log.continued.bytes)
        yield Reading(_no_increments(), [log.continued], account)


def _readings(log: "_Log", data: Bytes, *, last: bool) -> Generator[Reading, None, int]:
    """All items of `data`; returns the byte after the last one."""
    start = 0
    while len((items := find_items(data, start, last=last)).kind):
        yield log.reading(data, items)
        start = items.end
    log.offset += start
    return start


class _Log:
    """The state between chunks.

    `offset`: byte in the file where the data begin; `continued`: a refused stretch not ended yet.
    """

    def __init__(self) -> None:
        self.offset = 0
        self.continued: RefusedLine | None = None
        self._line, self._record, self._rolled_ns = 1, 0, 0
        self._message: int | None = None  # the number of the IMU message that is read
        self._last_stamp: int | None = None

    def reading(self, data: Bytes, items: Items) -> Reading:
        """The contents of some items."""
        reasons = _parse_unusual(data, items)
        kind, code = items.kind, items.code
        if self._message is None and (kind == IMU).any():
            self._message = int(np.bincount(code[kind == IMU]).argmax())
        selected = True if self._message is None else code == self._message
        decoded = (kind == IMU) & (code == self._message)
        invalid = (kind == UNPARSED) & selected
        reasons = {index: reasons[index] for index in np.flatnonzero(invalid).tolist()}
        damaged = np.flatnonzero((kind == kernel.DAMAGE) | (kind == kernel.CONTINUED)).tolist()
        reasons |= {index: why_refused(_bytes(data, items, index)) for index in damaged}
        lines = self._lines(kind)
        counted = decoded | invalid | self._damaged_records(data, items, damaged)
        refused = list(self._refused(data, items, lines, reasons))

        account = Account()
        kept = slice(None) if decoded.all() else decoded  # a slice copies nothing
        if self._message is not None:
            account.add_all(DECODED, name_of(self._message), items.length[kept])
        account.add_all(BLANK, "", items.length[kind == kernel.BLANK])
        for line in refused:
            account.add(REFUSED, "", 1, line.bytes)
        _add_others(account, data, items, decoded | invalid)
        records = _numbers(counted, self._record)
        self._record = int(records[-1]) + 1
        increments = Increments(
            records[kept],
            self.offset + items.start[kept],
            lines[kept],
            self._unrolled(items.stamp[kept]),
            items.status[kept],
            items.counts[kept],
            items.imu_type[kept],
        )
        return Reading(increments, refused, account)

    def _lines(self, kind: NDArray[np.int8]) -> Integers:
        """Number of each item, a continued one counted once."""
        after_continued = np.append(self.continued is not None, kind[:-1] == kernel.CONTINUED)
        same = after_continued & ((kind == kernel.DAMAGE) | (kind == kernel.CONTINUED))
        lines = _numbers(~same, self._line)
        self._line = int(lines[-1]) + 1
        return lines

    def _damaged_records(self, data: Bytes, items: Items, damaged: list[int]) -> Booleans:
        """Which damaged items begin like the message that is read."""
        records = np.zeros(len(items.kind), bool)
        if (message := self._message) is None:
            return records
        begin = first_bytes(message)
        number = NUMBERS[message % BINARY]
        for index in damaged:
            same = not message & BINARY or items.code[index] == number
            whole = items.kind[index] == kernel.DAMAGE
            records[index] = whole and same and _bytes(data, items, index).startswith(begin)
        return records

    def _refused(
        self, data: Bytes, items: Items, lines: Integers, reasons: dict[int, str]
    ) -> Iterator[RefusedLine]:
        """The refused items; a continued one when it has ended."""
        for index in sorted(reasons):
            length = int(items.length[index])
            if self.continued is not None and lines[index] != self.continued.line:
                yield self.continued
                self.continued = None
            if self.continued is None:
                text = quoted(_bytes(data, items, index).rstrip(b"\r\n"))
                offset = self.offset + int(items.start[index])
                line = RefusedLine(int(lines[index]), offset, length, reasons[index], text)
            else:
                size = self.continued.bytes + length
                line = replace(self.continued, bytes=size, reason=too_long(size))
            if items.kind[index] == kernel.CONTINUED:
                self.continued = replace(line, reason=too_long(line.bytes))
            else:
                self.continued = None
                yield line

    def _unrolled(self, stamps: Integers) -> Integers:
        """The times with weeks that go on after a rollover."""
        if not len(stamps):
            return stamps
        before = stamps[0] if self._last_stamp is None else self._last_stamp
        self._last_stamp = int(stamps[-1])
        earliest, latest = min(before, stamps.min()), max(before, stamps.max())
        if not self._rolled_ns and latest - earliest < ROLLOVER_NS - WEEK_NS:
            return stamps
        steps = np.diff(stamps, prepend=before)
        rolls = np.rint(steps / ROLLOVER_NS) * (np.abs(np.abs(steps) - ROLLOVER_NS) < WEEK_NS)
        rolled = self._rolled_ns - np.cumsum(rolls).astype(np.int64) * ROLLOVER_NS
        self._rolled_ns = int(rolled[-1])
        return np.asarray(stamps + rolled)


def _parse_unusual(data: Bytes, items: Items) -> dict[int, str]:
    """Fill in the fields of UNPARSED messages; why the others are refused, by index."""
    reasons = {}
    for index in np.flatnonzero(items.kind == UNPARSED).tolist():
        try:
            fields = fields_of(_bytes(data, items, index), int(items.code[index]))
        except ValueError as error:
            reasons[index] = _("right checksum, but {error}", error=error)
        else:
            items.stamp[index], items.status[index] = fields.stamp, fields.status
            items.counts[index], items.imu_type[index] = fields.counts, fields.imu_type
            items.kind[index] = IMU
    return reasons


def _bytes(data: Bytes, items: Items, index: int) -> bytes:
    """The bytes of an item."""
    return data[items.start[index] : items.start[index] + items.length[index]].tobytes()


def _numbers(counted: Booleans, first: int) -> Integers:
    """The number of each item if the first one counted has number `first`, (n,)."""
    if counted.all():
        return np.arange(first, first + len(counted))
    return np.asarray(np.cumsum(counted) + (first - 1))


def _add_others(account: Account, data: Bytes, items: Items, own: Booleans) -> None:
    """Count all other messages, by name."""
    kind, code = items.kind, items.code
    others = ((kind == IMU) | (kind == UNPARSED)) & ~own
    for number in np.unique(code[others]).tolist():
        same = others & (code == number)
        account.add_all(OTHER_MESSAGE, name_of(number), items.length[same])
    for number in np.unique(code[kind == kernel.OTHER_BINARY]).tolist():
        same = (kind == kernel.OTHER_BINARY) & (code == number)
        account.add_all(OTHER_MESSAGE, f"binary {number}", items.length[same])
    lines: Counter[bytes] = Counter()
    sizes: Counter[bytes] = Counter()
    for index in np.flatnonzero(kind == kernel.OTHER_TEXT).tolist():
        start = items.start[index] + 1
        name = data[start : start + code[index]].tobytes()
        lines[name] += 1
        sizes[name] += int(items.length[index])
    for name, count in lines.items():
        account.add(OTHER_MESSAGE, quoted(name), count, sizes[name])


def _no_increments() -> Increments:
    none, counts = np.zeros(0, np.int64), np.zeros((0, 6), np.int32)
    return Increments(none, none, none, none, none.astype(np.uint32), counts, none.astype(np.int16))
