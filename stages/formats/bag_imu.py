"""The messages sensor_msgs/Imu of a ROS bag as a table; a message is a row.

Its columns are

    stamp                       time in the header of the message, s since 1970
    received                    time when it was put into the bag, s since 1970
    angular_velocity.x .y .z    rad/s
    linear_acceleration.x .y .z m/s²

A time is the float nearest to the nanoseconds in the bag: to 0.12 µs in our days. What a bag says
of how its messages are laid out is not used, only ROS' own definition of sensor_msgs/Imu.

Source: https://docs.ros.org/en/noetic/api/sensor_msgs/html/msg/Imu.html
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from inertial.tables.errors import Refusal
from stages.formats.account import OTHER_MESSAGE, Account
from stages.formats.containers import PORTION_ROWS, Portion, Table
from stages.formats.fields import NumberField

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
    """What a connection of the bag carries."""

    name: str
    kind: str  # of its messages, as ROS 2 writes it: sensor_msgs/msg/Imu


@dataclass(frozen=True)
class Message:
    """A message as it stands in the bag."""

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
    understood: Callable[[bytes], Any]  # a message of ROS, of the bytes of a sensor_msgs/Imu


def imu_table(path: Path, layout: Mapping[str, Any], bag: Bag) -> Table:
    """The topic that the layout names, else the only one with sensor_msgs/Imu.

    Raises
    ------
    Refusal
        where there is no such topic, or several and none is named
    """
    topic = Topic(_topic(path, layout.get("topic"), bag.topics), IMU)
    return Table(COLUMNS, partial(_portions, bag, topic))


def _topic(path: Path, asked: str | None, topics: Mapping[int, Topic]) -> str:
    there = sorted({topic.name for topic in topics.values() if topic.kind == IMU})
    if asked in there:
        return str(asked)
    if asked is None and len(there) == 1:
        return there[0]
    others = sorted({f"{topic.name} ({topic.kind})" for topic in topics.values()})
    if asked is not None:
        found = f"no topic '{asked}' with {IMU}"
    else:
        found = f"{len(there) or 'no'} topics with {IMU}"
    raise Refusal(
        path.name,
        "topic",
        found,
        f"one of {', '.join(there or others) or 'its topics, of which it has none'}",
        "name the topic of the IMU in the format's key topic",
    )


def _portions(bag: Bag, topic: Topic, indices: Sequence[int]) -> Iterator[Portion]:
    rows: list[tuple[float, ...]] = []
    lost: dict[int, str] = {}
    account = Account()
    for message in bag.messages():
        if isinstance(message, Gap):
            lost[len(rows)] = message.reason
            rows.append(_UNREADABLE)
        elif (of := bag.topics.get(message.connection)) != topic:
            name = f"connection {message.connection}" if of is None else of.name
            account.add(OTHER_MESSAGE, name, 1, 0)
        else:
            try:
                rows.append(_row(message, bag.understood(message.data)))
            except Exception as error:  # rosbags' own, and what damage makes of it
                lost[len(rows)] = f"no {IMU}: {' '.join(str(error).split())}"
                rows.append(_UNREADABLE)
        if len(rows) == PORTION_ROWS:
            yield _portion(rows, indices, lost, account)
            rows, lost, account = [], {}, Account()
    yield _portion(rows, indices, lost, account)


def _portion(
    rows: Sequence[tuple[float, ...]],
    indices: Sequence[int],
    lost: Mapping[int, str],
    account: Account,
) -> Portion:
    values = np.array(rows, np.float64).reshape(len(rows), len(COLUMNS))
    fields = {index: NumberField(values[:, index]) for index in indices}
    return Portion(len(rows), fields, lost, account)


def _row(message: Message, imu: Any) -> tuple[float, ...]:
    """The values of one message in the order of `COLUMNS`."""
    stamp = imu.header.stamp.sec * 10**9 + imu.header.stamp.nanosec
    rate, force = imu.angular_velocity, imu.linear_acceleration
    times = stamp / NANOSECONDS, message.received / NANOSECONDS
    return (*times, rate.x, rate.y, rate.z, force.x, force.y, force.z)
