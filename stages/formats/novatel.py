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
)
from stages.formats.novatel_messages import IMU_MESSAGES
from stages.formats.novatel_scan import LENGTH, START, WHAT, WHICH, Scan, scan
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
    with path.open("rb") as file:
        rest = b""
        while more := file.read(piece_bytes):
            data = rest + more
            consumed = yield from _items_of(log, data, last=False)
            rest = data[consumed:]
        yield from _items_of(log, rest, last=True)
    if log.going_on is not None:
        yield log.end()


def _items_of(log: "_Log", data: bytes, *, last: bool) -> Generator[Reading, None, int]:
    """All items of some bytes; returns the byte after the last."""
    start = 0
    while len((found := scan(data, start, last=last)).items):
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

    def reading(self, data: bytes, found: Scan) -> Reading:
        """What some items hold."""
        what, start, length, which = found.items.T
        for index in np.flatnonzero(self._may_be_ours(what == UNSURE, which)).tolist():
            if told := fields_of(data[start[index] : start[index] + length[index]]):
                found.fields[STAMP][index], found.fields[STATUS][index] = told.stamp, told.status
                found.fields[COUNTS][index], found.fields[TYPE][index] = told.counts, told.imu
                what[index] = IMU
        self._choose(which[what == IMU])
        ours = (which == self._message) & (what == IMU)
        unsure = self._may_be_ours(what == UNSURE, which)
        lines = self._lines(what)

        account, reasons = Account(), {}
        for index in np.flatnonzero(unsure).tolist():
            reasons[index] = why_unsure(data[start[index] : start[index] + length[index]])
        refused_as_ours = self._refused_as_ours(data, found.items)
        for index in np.flatnonzero((what == DAMAGE) | (what == GOES_ON)).tolist():
            reasons[index] = why_refused(data[start[index] : start[index] + length[index]])
        refused = list(self._refused(data, found.items, lines, reasons))

        counted = ours | unsure | refused_as_ours
        record = self._records + np.cumsum(counted) - 1
        self._records += int(counted.sum())
        if self._message is not None:
            account.add_all(DECODED, IMU_MESSAGES[self._message].name, length[ours])
        account.add_all(BLANK, "", length[what == EMPTY])
        for line in refused:
            account.add(REFUSED, "", 1, line.bytes)
        _add_others(account, data, found.items, ours | unsure)
        kept = slice(None) if ours.all() else ours  # what need not be picked out is not copied
        stamp, status, counts, imu = found.fields
        increments = Increments(
            record[kept],
            self.offset + start[kept],
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

    def _may_be_ours(self, some: Truths, which: Integers) -> Truths:
        """Which of some IMU messages are those that are read, as far as that is known yet."""
        return some if self._message is None else some & (which == self._message)

    def _choose(self, which: Integers) -> None:
        """The IMU message that comes most often where the first ones are."""
        if self._message is None and len(which):
            self._message = int(np.bincount(which).argmax())

    def _lines(self, what: Integers) -> Integers:
        """Number of each item, what goes on counted once."""
        before = np.append(self.going_on is not None, what[:-1] == GOES_ON)
        goes_on = before & ((what == DAMAGE) | (what == GOES_ON))
        lines = self._line - 1 + np.cumsum(~goes_on)
        self._line = int(lines[-1]) + 1
        return np.asarray(lines)

    def _refused_as_ours(self, data: bytes, items: Integers) -> Truths:
        """Which refused items would have been records, as far as their beginning tells."""
        as_ours = np.zeros(len(items), bool)
        if self._message is None:
            return as_ours
        message = IMU_MESSAGES[self._message]
        for index in np.flatnonzero(items[:, WHAT] == DAMAGE).tolist():
            numbered = message.text or items[index, WHICH] == message.number
            as_ours[index] = numbered and data.startswith(message.begins, items[index, START])
        return as_ours

    def _refused(
        self, data: bytes, items: Integers, lines: Integers, reasons: dict[int, str]
    ) -> Iterator[RefusedLine]:
        """The refused items; what goes on is told when it has ended."""
        for index in sorted(reasons):
            start, length = items[index, START], int(items[index, LENGTH])
            if self.going_on is not None and lines[index] != self.going_on.line:
                yield self.going_on
                self.going_on = None
            if self.going_on is None:
                text = quoted(data[start : start + length].rstrip(b"\r\n"))
                one = RefusedLine(
                    int(lines[index]), self.offset + int(start), length, reasons[index], text
                )
            else:
                size = self.going_on.bytes + length
                one = replace(self.going_on, bytes=size, reason=_endless(size))
            if items[index, WHAT] == GOES_ON:
                self.going_on = replace(one, reason=_endless(one.bytes))
            else:
                self.going_on = None
                yield one

    def _unrolled(self, stamps: Integers) -> Integers:
        """The times, weeks that began anew going on."""
        if not len(stamps):
            return stamps
        before = stamps[0] if self._stamp is None else self._stamp
        steps = np.diff(stamps, prepend=before)
        if not self._rolled and np.abs(steps).max() < ROLL - WEEK_NS:
            self._stamp = int(stamps[-1])
            return stamps
        rolls = np.rint(steps / ROLL) * (np.abs(np.abs(steps) - ROLL) < WEEK_NS)
        self._stamp = int(stamps[-1])
        rolled = self._rolled - np.cumsum(rolls).astype(np.int64)
        self._rolled = int(rolled[-1])
        return np.asarray(stamps + rolled * ROLL)


def _add_others(account: Account, data: bytes, items: Integers, ours: Truths) -> None:
    """Count all other messages, by name."""
    what, start, length, which = items.T
    others = ((what == IMU) | (what == UNSURE)) & ~ours
    for number in np.unique(which[others]).tolist():
        same = others & (which == number)
        account.add_all(OTHER_MESSAGE, IMU_MESSAGES[number].name, length[same])
    for number in np.unique(which[what == OTHER_BINARY]).tolist():
        same = (what == OTHER_BINARY) & (which == number)
        account.add_all(OTHER_MESSAGE, f"binary {number}", length[same])
    lines: Counter[bytes] = Counter()
    sizes: Counter[bytes] = Counter()
    for row in np.flatnonzero(what == OTHER_TEXT).tolist():
        name = data[start[row] + 1 : start[row] + 1 + which[row]]
        lines[name] += 1
        sizes[name] += int(length[row])
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
