"""A bag of ROS 2 in a database of SQLite, the .db3 file alone; `bags` lists its columns.

The metadata.yaml that lies beside it is not needed. The database is only read, and no file is made
beside it.

Source: https://github.com/ros2/rosbag2/tree/humble/rosbag2_storage_default_plugins
"""

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from typing import Any

from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore

from inertial.formats.containers.bags import IMU, Bag, Gap, Message, Topic, imu_table
from inertial.formats.containers.container import Table
from inertial.tables.errors import Refusal
from inertial.text.messages import _

MAX_MESSAGE_BYTES = 1 << 26
_ENCODING = "cdr"  # of the messages of ROS 2
_TABLES = (
    "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('messages', 'topics')"
)

_TOPICS = "SELECT id, name, type, serialization_format FROM topics"
_MESSAGES = "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id"


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The bag at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where there is no topic of an IMU, or several and none is named; where part of the bag
        lies beside it
    ValueError
        where the database is no bag
    """
    _refuse_open_bag(path)
    database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro&immutable=1", uri=True)
    try:
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_MESSAGE_BYTES)
        database.execute("PRAGMA trusted_schema = OFF")  # views of the bag call no functions
        database.execute("PRAGMA cell_size_check = ON")
        if database.execute(_TABLES).fetchone() != (2,):
            raise ValueError("a database without the tables messages and topics")
        topics = {
            int(number): Topic(str(name), kind_of(str(kind), form))
            for number, name, kind, form in database.execute(_TOPICS)
        }
        yield imu_table(path, layout, Bag(topics, partial(_messages, database), deserialize))
    finally:
        database.close()


def deserialize(data: bytes) -> Any:
    """The sensor_msgs/Imu in `data`; an error of rosbags where there is none."""
    return _store().deserialize_cdr(data, IMU)


@cache
def _store() -> Typestore:
    return get_typestore(Stores.ROS2_HUMBLE)


def kind_of(schema: str, encoding: str) -> str:
    """The kind of the messages of a topic, or their encoding where it is unknown."""
    return schema if encoding == _ENCODING else f"in {encoding}"


def _refuse_open_bag(path: Path) -> None:
    """Refuse a bag whose last messages still lie in the database's journal."""
    journal = path.with_name(path.name + "-wal")
    if journal.is_file() and journal.stat().st_size:
        raise Refusal(
            path.name,
            "",
            _("a bag that was not closed: messages lie in {name}", name=journal.name),
            _("all messages in the bag"),
            _("put them there: sqlite3 {name} 'PRAGMA wal_checkpoint(TRUNCATE)'", name=path.name),
        )


def _messages(database: sqlite3.Connection) -> Iterator[Message | Gap]:
    last: int | None = None
    try:
        for number, topic, received, data in database.execute(_MESSAGES):
            # Damage can lead the library in circles, but never to larger numbers.
            if not isinstance(number, int) or (last is not None and number <= last):
                yield Gap(
                    _(
                        "the bag cannot be read any further: message {number} after {last}",
                        number=number,
                        last=last,
                    )
                )
                return
            last = number
            if all(map(isinstance, (topic, received, data), (int, int, bytes))):
                yield Message(topic, received, data)
            else:
                yield Gap(_("message {number} is no message", number=number))
    except (sqlite3.Error, OverflowError) as error:
        yield Gap(_("the bag cannot be read any further: {error}", error=error))
