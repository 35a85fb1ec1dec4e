"""What bags of ROS share: the records of a bag, and its messages sensor_msgs/Imu as a table.

A message is a row. The columns are

    stamp                       time in the header of the message, s since 1970
    received                    time when it was put into the bag, s since 1970
    angular_velocity.x .y .z    rad/s
    linear_acceleration.x .y .z m/s²

A time is the float nearest to the nanoseconds in the bag: today within 0.12 µs. The definition of
messages in the bag is not used, only that of sensor_msgs/Imu in ROS.

Records are read from front to back, also where a bag was never closed or is damaged. Messages lie
in chunks of records, each compressed on its own. The readers of rosbags need the index at the end
and stop at the first damaged chunk; so its parsers of records are used here without the index. A
damaged chunk costs its messages, which one refused row represents.

Source: https://docs.ros.org/en/noetic/api/sensor_msgs/html/msg/Imu.html
"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from io import BufferedReader, BytesIO, FileIO
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from inertial.formats.account import OTHER_MESSAGE, Account
from inertial.formats.columns.column_values import NumberValues
from inertial.formats.containers.container import BATCH_ROWS, Batch, Table
from inertial.tables.errors import Refusal
from inertial.text.messages import _

IMU = "sensor_msgs/msg/Imu"
NANOSECONDS = 1e9  # in a second
COLUMNS = (
    "stamp",
    "received",
    *(f"angular_velocity.{axis}" for axis in "xyz"),
    *(f"linear_acceleration.{axis}" for axis in "xyz"),
)
_UNREADABLE = (np.nan,) * len(COLUMNS)


@dataclass(frozen=True)
class Topic:
    """The topic of a connection of the bag."""

    name: str
    kind: str  # of its messages, in the notation of ROS 2: sensor_msgs/msg/Imu


@dataclass(frozen=True)
class Message:
    """A message in the bag, not deserialized."""

    connection: int
    received: int  # ns since 1970
    data: bytes


@dataclass(frozen=True)
class Gap:
    """A stretch of the bag that cannot be read; it counts as one row, which is refused."""

    reason: str


@dataclass(frozen=True)
class Bag:
    """A bag of either kind."""

    topics: Mapping[int, Topic]  # by connection
    messages: Callable[[], Iterator[Message | Gap]]  # in the order in which they were received
    deserialize: Callable[[bytes], Any]  # of the bytes of a sensor_msgs/Imu


def imu_table(path: Path, layout: Mapping[str, Any], bag: Bag) -> Table:
    """The topic that the layout names, else the only one with sensor_msgs/Imu.

    Raises
    ------
    Refusal
        where there is no such topic, or several and none is named
    """
    topic = Topic(_topic(path, layout.get("topic"), bag.topics), IMU)
    return Table(COLUMNS, partial(_batches, bag, topic))


def _topic(path: Path, named: str | None, topics: Mapping[int, Topic]) -> str:
    there = sorted({topic.name for topic in topics.values() if topic.kind == IMU})
    if named in there:
        return str(named)
    if named is None and len(there) == 1:
        return there[0]
    others = sorted({f"{topic.name} ({topic.kind})" for topic in topics.values()})
    if named is not None:
        problem = _("no topic '{named}' with {imu}", named=named, imu=IMU)
    else:
        problem = _("{value} topics with {imu}", value=len(there) or "no", imu=IMU)
    raise Refusal(
        path.name,
        "topic",
        problem,
        _("one of {value}", value=", ".join(there or others) or "its topics, of which it has none"),
        _("name the topic of the IMU in the format's key topic"),
    )


def _batches(bag: Bag, topic: Topic, indices: Sequence[int]) -> Iterator[Batch]:
    rows: list[tuple[float, ...]] = []
    unreadable: dict[int, str] = {}
    account = Account()
    for message in bag.messages():
        if isinstance(message, Gap):
            unreadable[len(rows)] = message.reason
            rows.append(_UNREADABLE)
        elif (other := bag.topics.get(message.connection)) != topic:
            name = f"connection {message.connection}" if other is None else other.name
            account.add(OTHER_MESSAGE, name, 1, 0)
        else:
            try:
                rows.append(_row(message, bag.deserialize(message.data)))
            except MemoryError:
                raise
            except Exception as error:  # rosbags' own, and any that damage causes in it
                unreadable[len(rows)] = f"no {IMU}: {' '.join(str(error).split())}"
                rows.append(_UNREADABLE)
        if len(rows) == BATCH_ROWS:
            yield _batch(rows, indices, unreadable, account)
            rows, unreadable, account = [], {}, Account()
    yield _batch(rows, indices, unreadable, account)


def _batch(
    rows: Sequence[tuple[float, ...]],
    indices: Sequence[int],
    unreadable: Mapping[int, str],
    account: Account,
) -> Batch:
    values = np.array(rows, np.float64).reshape(len(rows), len(COLUMNS))
    columns = {index: NumberValues(values[:, index]) for index in indices}
    return Batch(len(rows), columns, unreadable, account)


def _row(message: Message, imu: Any) -> tuple[float, ...]:
    """The values of one message in the order of `COLUMNS`."""
    stamp = imu.header.stamp.sec * 10**9 + imu.header.stamp.nanosec
    rate, force = imu.angular_velocity, imu.linear_acceleration
    times = stamp / NANOSECONDS, message.received / NANOSECONDS
    return (*times, rate.x, rate.y, rate.z, force.x, force.y, force.z)


# ---- The records of a bag.


@dataclass(frozen=True)
class Record:
    """A record: its kind, its header where it has one, and its data."""

    kind: int
    header: Any
    data: bytes


@dataclass(frozen=True)
class Framing:
    """The records of one kind of bag."""

    first: int  # byte of the first record
    chunk: int  # kind of a chunk of records
    # Kind, header and length of the data of each record; the file is then at its data.
    heads: Callable[[BinaryIO], Iterator[tuple[int, Any, int]]]
    unpacked: Callable[[Record], bytes]  # the records in a chunk
    shows_closed: Callable[[int, Any, int], bool]  # by kind, header, and size of the file


class _File(BufferedReader):
    """A file of which no more is requested than there is, whatever a damaged length states."""

    def __init__(self, path: Path) -> None:
        super().__init__(FileIO(path))
        self._size = path.stat().st_size

    def read(self, size: int | None = -1, /) -> bytes:
        rest = max(self._size - self.tell(), 0)
        return super().read(rest if size is None or size < 0 else min(size, rest))


def bag_records(
    path: Path, framing: Framing, kinds: Collection[int], *, inside: bool
) -> Iterator[Record | Gap]:
    """The records of these kinds, also those `inside` chunks; a gap where some cannot be read."""
    size, closed = path.stat().st_size, False
    with _File(path) as file:
        file.seek(framing.first)
        try:
            for kind, header, length in _heads(file, framing, size):
                closed |= framing.shows_closed(kind, header, size)
                if kind == framing.chunk and inside:
                    chunk = Record(kind, header, file.read(length))
                    yield from _records_in(chunk, framing, kinds)
                elif kind in kinds:
                    yield Record(kind, header, file.read(length))
        except MemoryError:
            raise
        except Exception as error:  # rosbags' own, and any that damage causes in it
            yield Gap(_("the bag cannot be read any further: {error}", error=error))
            return
    if not closed:
        yield Gap(_("the bag was not closed: messages may be missing at its end"))


def _records_in(chunk: Record, framing: Framing, kinds: Collection[int]) -> Iterator[Record | Gap]:
    try:
        data = framing.unpacked(chunk)
        file = BytesIO(data)
        for kind, header, length in _heads(file, framing, len(data)):
            if kind in kinds:
                yield Record(kind, header, file.read(length))
    except MemoryError:
        raise
    except Exception as error:  # as above, and those of the compression
        yield Gap(_("a chunk of messages is damaged: {error}", error=error))


def _heads(file: BinaryIO, framing: Framing, size: int) -> Iterator[tuple[int, Any, int]]:
    """The heads of the records up to byte `size`; the data of each may be read before the next."""
    place = file.tell()
    heads = framing.heads(file)
    while place < size:
        try:
            head = next(heads, None)
        except MemoryError:
            raise
        except Exception as error:
            raise ValueError(f"the record at byte {place}: {error}") from error
        if head is None:
            return
        end = file.tell() + head[2]
        if end > size:
            raise EOFError(
                _(
                    "the record at byte {place} ends at byte {end}, the file at {size}",
                    place=place,
                    end=end,
                    size=size,
                )
            )
        yield head
        file.seek(end)
        place = end
