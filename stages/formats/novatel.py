"""A log of a NovAtel receiver: the increments of its IMU among any other messages, text and binary.

Which of the eight IMU messages the log is read by, its first ones tell; a receiver may send the
same samples as several, and those count as other messages. No message is used whose checksum
is not right. Which axis a count stands for and how large it is belongs to the instrument, not to
this format.

A receiver that counts weeks in ten bits begins anew after week 1023; within a log they go on.
"""

from collections import Counter
from collections.abc import Generator, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stages.formats.account import (
    BLANK,
    DECODED,
    OTHER_MESSAGE,
    REFUSED,
    Account,
    RefusedLine,
    quoted,
)
from stages.formats.novatel_items import (
    COUNTS,
    DAMAGE,
    EMPTY,
    GOES_ON,
    IMU,
    OTHER_BINARY,
    OTHER_TEXT,
    STAMP,
    STATUS,
    TYPE,
    UNSURE,
    WEEK_NS,
    Bytes,
)
from stages.formats.novatel_messages import IMU_MESSAGES
from stages.formats.novatel_scan import Scan, scan
from stages.formats.novatel_words import fields_of, why_refused, why_unsure
from stages.formats.pieces import LONGEST_LINE, PIECE_BYTES, Integers

ROLL = 1024 * WEEK_NS  # the weeks that ten bits count

Truths = NDArray[np.bool_]


@dataclass(frozen=True)
class Increments:
    """What n messages of the IMU say."""

    record: Integers  # number among the IMU's messages of the log, refused ones counted, (n,)
    offset: Integers  # byte in the file where the message begins, (n,)
    line: Integers  # number of the line or binary message, from 1, (n,)
    stamp: Integers  # ns since the start of GPS time, (n,)
    status: NDArray[np.uint32]  # (n,)
    counts: NDArray[np.int32]  # as sent: accelerometer z, −y, x, gyro z, −y, x; (n, 6)
    imu: NDArray[np.int16]  # type of the IMU, −1 where the message does not tell, (n,)


@dataclass(frozen=True)
class Reading:
    """What a piece of the log holds."""

    records: Increments
    refused: list[RefusedLine]
    account: Account


def read(path: Path, piece_bytes: int = PIECE_BYTES) -> Iterator[Reading]:
    """The log at `path`, piece by piece."""
    log = _Log()
    buffer, held = np.empty(2 * piece_bytes, np.uint8), 0
    with path.open("rb") as file:
        while more := file.readinto(buffer.data[held : held + piece_bytes]):
            held += more
            consumed = yield from _items_of(log, buffer[:held], last=False)
            rest = buffer[consumed:held]
            if len(rest) + piece_bytes > len(buffer):
                buffer = np.empty(2 * len(buffer), np.uint8)
            held = len(rest)
            buffer[:held] = rest
    yield from _items_of(log, buffer[:held], last=True)
    if log.going_on is not None:
        yield log.end()


def _items_of(log: "_Log", data: Bytes, *, last: bool) -> Generator[Reading, None, int]:
    """All items of some bytes; returns the byte after the last."""
    data.flags.writeable = False
    start = 0
    while len((found := scan(data, start, last=last)).what):
        yield log.reading(data, found)
        start = found.consumed
    log.offset += start
    return start


class _Log:
    """How far a log is read.

    `offset`: byte in the file where the data begin; `going_on`: what is refused and goes on.
    """

    def __init__(self) -> None:
        self.offset = 0
        self.going_on: RefusedLine | None = None
        self._line, self._records, self._rolled = 1, 0, 0
        self._message: int | None = None  # the IMU message that is read
        self._stamp: int | None = None  # of the last record

    def reading(self, data: Bytes, found: Scan) -> Reading:
        """What some items hold."""
        what, which = found.what, found.which
        for index in np.flatnonzero(self._may_be_ours(what == UNSURE, which)).tolist():
            if told := fields_of(_text(data, found, index)):
                found.fields[STAMP][index], found.fields[STATUS][index] = told.stamp, told.status
                found.fields[COUNTS][index], found.fields[TYPE][index] = told.counts, told.imu
                what[index] = IMU
        if self._message is None:
            self._choose(which[what == IMU])
        ours = (which == self._message) & (what == IMU)
        unsure = self._may_be_ours(what == UNSURE, which)
        damaged = np.flatnonzero((what == DAMAGE) | (what == GOES_ON)).tolist()
        lines = self._lines(what)

        reasons = {index: why_refused(_text(data, found, index)) for index in damaged}
        for index in np.flatnonzero(unsure).tolist():
            reasons[index] = why_unsure(_text(data, found, index))
        refused_as_ours = self._refused_as_ours(data, found, damaged)
        refused = list(self._refused(data, found, lines, reasons))

        counted = ours | unsure | refused_as_ours
        kept = slice(None) if ours.all() else ours  # what need not be picked out is not copied
        account = Account()
        if self._message is not None:
            account.add_all(DECODED, IMU_MESSAGES[self._message].name, found.length[kept])
        account.add_all(BLANK, "", found.length[what == EMPTY])
        for line in refused:
            account.add(REFUSED, "", 1, line.bytes)
        _add_others(account, data, found, ours | unsure)
        stamp, status, counts, imu = found.fields
        increments = Increments(
            self._numbers(counted)[kept],
            self.offset + found.start[kept],
            lines[kept],
            self._unrolled(stamp[kept]),
            status[kept],
            counts[kept],
            imu[kept],
        )
        return Reading(increments, refused, account)

    def end(self) -> Reading:
        """What was refused up to the end of the file."""
        ended, self.going_on = self.going_on, None
        assert ended is not None
        account = Account()
        account.add(REFUSED, "", 1, ended.bytes)
        return Reading(_none(), [ended], account)

    def _may_be_ours(self, some: Truths, which: NDArray[np.int32]) -> Truths:
        """Which of some IMU messages are those that are read, as far as that is known yet."""
        return some if self._message is None else some & (which == self._message)

    def _choose(self, which: NDArray[np.int32]) -> None:
        """The IMU message that comes most often where the first ones are."""
        if len(which):
            self._message = int(np.bincount(which).argmax())

    def _numbers(self, counted: Truths) -> Integers:
        """Number of each record among those of the log; anything where it is none."""
        numbers = _count(counted, self._records)
        self._records = int(numbers[-1]) + 1
        return numbers

    def _lines(self, what: NDArray[np.int8]) -> Integers:
        """Number of each item, what goes on counted once."""
        before = np.append(self.going_on is not None, what[:-1] == GOES_ON)
        goes_on = before & ((what == DAMAGE) | (what == GOES_ON))
        lines = _count(~goes_on, self._line)
        self._line = int(lines[-1]) + 1
        return lines

    def _refused_as_ours(self, data: Bytes, found: Scan, damaged: list[int]) -> Truths:
        """Which refused items would have been records, as far as their beginning tells."""
        as_ours = np.zeros(len(found.what), bool)
        if self._message is None:
            return as_ours
        message = IMU_MESSAGES[self._message]
        for index in damaged:
            numbered = message.text or found.which[index] == message.number
            begins = _text(data, found, index, len(message.begins)) == message.begins
            as_ours[index] = found.what[index] == DAMAGE and numbered and begins
        return as_ours

    def _refused(
        self, data: Bytes, found: Scan, lines: Integers, reasons: dict[int, str]
    ) -> Iterator[RefusedLine]:
        """The refused items; what goes on is told when it has ended."""
        for index in sorted(reasons):
            length = int(found.length[index])
            if self.going_on is not None and lines[index] != self.going_on.line:
                yield self.going_on
                self.going_on = None
            if self.going_on is None:
                text = quoted(_text(data, found, index).rstrip(b"\r\n"))
                offset = self.offset + int(found.start[index])
                one = RefusedLine(int(lines[index]), offset, length, reasons[index], text)
            else:
                size = self.going_on.bytes + length
                one = replace(self.going_on, bytes=size, reason=_endless(size))
            if found.what[index] == GOES_ON:
                self.going_on = replace(one, reason=_endless(one.bytes))
            else:
                self.going_on = None
                yield one

    def _unrolled(self, stamps: Integers) -> Integers:
        """The times, weeks that began anew going on."""
        if not len(stamps):
            return stamps
        before = stamps[0] if self._stamp is None else self._stamp
        self._stamp = int(stamps[-1])
        earliest, latest = min(before, stamps.min()), max(before, stamps.max())
        if not self._rolled and latest - earliest < ROLL - WEEK_NS:
            return stamps
        steps = np.diff(stamps, prepend=before)
        rolls = np.rint(steps / ROLL) * (np.abs(np.abs(steps) - ROLL) < WEEK_NS)
        rolled = self._rolled - np.cumsum(rolls).astype(np.int64)
        self._rolled = int(rolled[-1])
        return np.asarray(stamps + rolled * ROLL)


def _text(data: Bytes, found: Scan, index: int, most: int | None = None) -> bytes:
    """The bytes of an item, or the first ones of them."""
    start, length = found.start[index], found.length[index]
    return data[start : start + (length if most is None else min(length, most))].tobytes()


def _count(some: Truths, first: int) -> Integers:
    """The number of each, if the first of them is number `first`, (n,)."""
    if some.all():
        return np.arange(first, first + len(some))
    return np.asarray(np.cumsum(some) + (first - 1))


def _add_others(account: Account, data: Bytes, found: Scan, ours: Truths) -> None:
    """Count all other messages, by name."""
    what, which = found.what, found.which
    others = ((what == IMU) | (what == UNSURE)) & ~ours
    for number in np.unique(which[others]).tolist():
        same = others & (which == number)
        account.add_all(OTHER_MESSAGE, IMU_MESSAGES[number].name, found.length[same])
    for number in np.unique(which[what == OTHER_BINARY]).tolist():
        same = (what == OTHER_BINARY) & (which == number)
        account.add_all(OTHER_MESSAGE, f"binary {number}", found.length[same])
    lines: Counter[bytes] = Counter()
    sizes: Counter[bytes] = Counter()
    for index in np.flatnonzero(what == OTHER_TEXT).tolist():
        name = _text(data, found, index, 1 + int(which[index]))[1:]
        lines[name] += 1
        sizes[name] += int(found.length[index])
    for name, count in lines.items():
        account.add(OTHER_MESSAGE, quoted(name), count, sizes[name])


def _endless(size: int) -> str:
    return f"{size} bytes without a line end, expected at most {LONGEST_LINE}"


def _none() -> Increments:
    empty = np.zeros(0, np.int64)
    return Increments(
        empty,
        empty,
        empty,
        empty,
        np.zeros(0, np.uint32),
        np.zeros((0, 6), np.int32),
        np.zeros(0, np.int16),
    )
