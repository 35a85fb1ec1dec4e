"""A bag of ROS 1, version 2.0; `bags` lists its columns.

Source: http://wiki.ros.org/Bags/Format/2.0
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache, partial
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from rosbags.rosbag1.reader import Header, ReaderError, RecordType, decompressors, read_uint32
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.msg import normalize_msgtype
from rosbags.typesys.store import Typestore

from inertial.formats.containers.bags import (
    IMU,
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
from inertial.text.messages import _

_MAGIC = b"#ROSBAG V2.0\n"


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The bag at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where there is no topic of an IMU, or several and none is named
    """
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            raise ValueError(f"not {_MAGIC.decode().strip()}")
    # A closed bag repeats its connections in the index, where no chunk must be unpacked for them.
    topics = _topics(path, inside=False) or _topics(path, inside=True)
    deserialize = partial(_store().deserialize_ros1, typename=IMU)
    yield imu_table(path, layout, Bag(topics, partial(_messages, path), deserialize))


@cache
def _store() -> Typestore:
    return get_typestore(Stores.ROS1_NOETIC)


def _heads(file: BinaryIO) -> Iterator[tuple[int, Header, int]]:
    while True:
        header = Header.read(file)
        kind = header.get_uint8("op") if "op" in header else 0
        yield kind, header, read_uint32(file)


def unpacked(chunk: Record) -> bytes:
    """The records in a chunk."""
    compression, size = chunk.header.get_string("compression"), chunk.header.get_uint32("size")
    if compression not in decompressors:
        raise ReaderError(
            _(
                "compression '{compression}', expected {decompressors}",
                compression=compression[:20],
                decompressors=", ".join(decompressors),
            )
        )
    data = decompressors[compression](chunk.data)
    if len(data) != size:
        raise ReaderError(_("a chunk of {data} bytes, expected {size}", data=len(data), size=size))
    return data


def _shows_closed(kind: int, header: Header, size: int) -> bool:
    return kind == RecordType.BAGHEADER and 0 < header.get_uint64("index_pos") <= size


_FRAMING = Framing(len(_MAGIC), RecordType.CHUNK, _heads, unpacked, _shows_closed)


def _topics(path: Path, *, inside: bool) -> dict[int, Topic]:
    """The topic of each connection, as stated outside the chunks or `inside` them."""
    topics: dict[int, Topic] = {}
    definition = _store().generate_msgdef(IMU)[1]
    for record in bag_records(path, _FRAMING, (RecordType.CONNECTION,), inside=inside):
        if isinstance(record, Gap):
            continue
        # The data are fields like those of a header, which is preceded by its length.
        size = len(record.data).to_bytes(4, "little")
        stated = Header.read(BytesIO(size + record.data))
        kind = normalize_msgtype(stated.get_string("type"))
        if kind == IMU and stated.get_string("md5sum") not in (definition, "*"):
            kind += " of another definition"
        connection = record.header.get_uint32("conn")
        topics[connection] = Topic(record.header.get_string("topic"), kind)
    return topics


def _messages(path: Path) -> Iterator[Message | Gap]:
    for record in bag_records(path, _FRAMING, (RecordType.MSGDATA,), inside=True):
        if isinstance(record, Gap):
            yield record
        else:
            header = record.header
            yield Message(header.get_uint32("conn"), header.get_time("time"), record.data)
