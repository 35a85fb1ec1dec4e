"""A bag of ROS 2 in the container MCAP; `bags` lists its columns.

Source: https://mcap.dev/spec
"""

import struct
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from rosbags.rosbag2.storage_mcap import decompress, read_exact, read_sized, read_string

from inertial.formats.containers.bags import (
    Bag,
    Framing,
    Gap,
    Message,
    Record,
    Topic,
    bag_records,
    imu_table,
)
from inertial.formats.containers.container import Table
from inertial.formats.containers.ros2_bag import deserialize, kind_of
from inertial.text.messages import _

_MAGIC = b"\x89MCAP0\r\n"
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK = 2, 3, 4, 5, 6  # kinds of records
_MESSAGE_HEAD = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The bag at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where there is no topic of an IMU, or several and none is named
    """
    # A closed bag repeats its channels in the summary, where no chunk must be unpacked for them.
    topics = _topics(path, inside=False) or _topics(path, inside=True)
    yield imu_table(path, layout, Bag(topics, partial(_messages, path), deserialize))


def _heads(file: BinaryIO) -> Iterator[tuple[int, None, int]]:
    kind = None
    while kind != _FOOTER:
        kind, length = struct.unpack("<BQ", read_exact(file, 9))
        yield kind, None, length


def unpacked(chunk: Record) -> bytes:
    """The records in a chunk."""
    content = BytesIO(chunk.data)
    _, _, size, checksum = struct.unpack("<QQQI", read_exact(content, 28))
    compression = read_string(content)
    return decompress(read_sized(content), compression, size, checksum)


_FRAMING = Framing(len(_MAGIC), _CHUNK, _heads, unpacked, lambda kind, *_: kind == _FOOTER)


def _topics(path: Path, *, inside: bool) -> dict[int, Topic]:
    """The topic of each channel, as stated outside the chunks or `inside` them."""
    kinds: dict[int, str] = {}
    topics: dict[int, Topic] = {}
    for record in bag_records(path, _FRAMING, (_SCHEMA, _CHANNEL), inside=inside):
        if isinstance(record, Gap):
            continue
        content = BytesIO(record.data)
        if record.kind == _SCHEMA:
            (number,) = struct.unpack("<H", read_exact(content, 2))
            kinds[number] = read_string(content)
        else:
            number, schema = struct.unpack("<HH", read_exact(content, 4))
            name, encoding = read_string(content), read_string(content)
            topics[number] = Topic(name, kind_of(kinds.get(schema, "of unknown kind"), encoding))
    return topics


def _messages(path: Path) -> Iterator[Message | Gap]:
    for record in bag_records(path, _FRAMING, (_MESSAGE,), inside=True):
        if isinstance(record, Gap):
            yield record
        elif len(record.data) < _MESSAGE_HEAD.size:
            yield Gap(_("a message of {data} bytes, expected at least 22", data=len(record.data)))
        else:
            channel, _unused, received, _unused = _MESSAGE_HEAD.unpack_from(record.data)
            yield Message(channel, received, record.data[_MESSAGE_HEAD.size :])
