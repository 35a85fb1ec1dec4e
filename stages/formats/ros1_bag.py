"""A bag of ROS 1, version 2.0, read from front to back: `bag_imu` tells its columns.

A record is a header of named fields and its data. Messages lie in chunks of records, each packed on
its own; an index at the end is not needed, so that a bag can be read that was never closed. A chunk
that is damaged costs its messages, and the refused row that stands for them says so.

Source: http://wiki.ros.org/Bags/Format/2.0
"""

import struct
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, partial
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.msg import normalize_msgtype
from rosbags.typesys.store import Typestore

from inertial.tables.errors import Refusal
from stages.formats.bag_chunks import unpacked
from stages.formats.bag_imu import IMU, Bag, Gap, Message, Topic, imu_table
from stages.formats.containers import Table
from stages.formats.limits import refuse_piece

_MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _BAG, _CHUNK, _CONNECTION = 2, 3, 5, 7  # the field op of a record
_LARGEST_HEADER = 1 << 24  # byte
_DAMAGE = (ValueError, KeyError, EOFError, OSError, struct.error)


@dataclass(frozen=True)
class _Record:
    """A record of the bag, the file standing where its data begin."""

    fields: Mapping[str, bytes]
    length: int  # of the data, byte

    @property
    def kind(self) -> int:
        return self.fields["op"][0] if self.fields.get("op") else 0

    def integer(self, name: str) -> int:
        return int.from_bytes(self.fields[name], "little")


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The bag at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where no topic is the IMU's or several may be, or a chunk claims to be too large
    """
    # Beside its index a closed bag has its connections once more, so no chunk is unpacked for them.
    topics = _topics(path, inside=False) or _topics(path, inside=True)
    understood = partial(_store().deserialize_ros1, typename=IMU)
    yield imu_table(path, layout, Bag(topics, partial(_messages, path), understood))


@cache
def _store() -> Typestore:
    return get_typestore(Stores.ROS1_NOETIC)


def _topics(path: Path, *, inside: bool) -> dict[int, Topic]:
    """What each connection carries, as stated outside the chunks or `inside` them."""
    topics: dict[int, Topic] = {}
    definition = _store().generate_msgdef(IMU)[1]
    for record, data in _walk(path, _CONNECTION, inside=inside):
        if isinstance(record, Gap):
            continue
        told = dict(_fields(data))
        kind = normalize_msgtype(told["type"].decode())
        if kind == IMU and told["md5sum"].decode() not in (definition, "*"):
            kind += " of another definition"
        topics[record.integer("conn")] = Topic(record.fields["topic"].decode(), kind)
    return topics


def _messages(path: Path) -> Iterator[Message | Gap]:
    for record, data in _walk(path, _MESSAGE, inside=True):
        if isinstance(record, Gap):
            yield record
        else:
            seconds, nanoseconds = struct.unpack("<II", record.fields["time"])
            yield Message(record.integer("conn"), seconds * 10**9 + nanoseconds, data)


def _walk(path: Path, wanted: int, *, inside: bool) -> Iterator[tuple[_Record | Gap, bytes]]:
    """The records of the `wanted` kind with their data; a gap where some cannot be read."""
    size = path.stat().st_size
    index = 0
    with path.open("rb") as file:
        if file.read(len(_MAGIC)) != _MAGIC:
            raise ValueError(f"not {_MAGIC.decode().strip()}")
        try:
            for record in _records(file, size):
                if record.kind == _BAG:
                    index = record.integer("index_pos")
                elif record.kind == _CHUNK and inside:
                    refuse_piece(path, "a chunk", record.length)
                    yield from _in_chunk(path, record, file.read(record.length), wanted)
                elif record.kind == wanted:
                    yield record, file.read(record.length)
        except _DAMAGE as error:
            yield Gap(f"the bag cannot be read any further: {error}"), b""
            return
    if not 0 < index <= size:
        yield Gap("the bag was not closed: messages may be missing at its end"), b""


def _in_chunk(
    path: Path, chunk: _Record, packed: bytes, wanted: int
) -> Iterator[tuple[_Record | Gap, bytes]]:
    try:
        compression = chunk.fields["compression"].decode()
        data = BytesIO(unpacked(path, packed, compression, chunk.integer("size")))
        for record in _records(data, chunk.integer("size")):
            if record.kind == wanted:
                yield record, data.read(record.length)
    except Refusal:
        raise
    except _DAMAGE as error:
        yield Gap(f"a chunk of messages is damaged: {error}"), b""


def _records(file: BinaryIO, size: int) -> Iterator[_Record]:
    """The records from here on; each may be read before the next is asked for."""
    while (place := file.tell()) < size:
        length = _integer(file, place)
        if length > min(_LARGEST_HEADER, size - place):
            raise EOFError(f"the record at byte {place} has a header of {length} bytes")
        fields = dict(_fields(file.read(length)))
        end = _integer(file, place) + file.tell()
        if end > size:
            raise EOFError(f"the record at byte {place} ends at byte {end}, the file at {size}")
        yield _Record(fields, end - file.tell())
        file.seek(end)


def _integer(file: BinaryIO, place: int) -> int:
    number = file.read(4)
    if len(number) < 4:
        raise EOFError(f"the file ends inside the record at byte {place}")
    return int.from_bytes(number, "little")


def _fields(header: bytes) -> Iterator[tuple[str, bytes]]:
    """Names and values in a header."""
    place = 0
    while place < len(header):
        length = int.from_bytes(header[place : place + 4], "little")
        name, equals, value = header[place + 4 : place + 4 + length].partition(b"=")
        if not equals:
            raise ValueError("a header field without a name")
        yield name.decode(), value
        place += 4 + length
