"""A bag of ROS 2 in the container MCAP, read from front to back: `bag_imu` tells its columns.

A record is a kind, a length and its data. Messages lie in chunks of records, each packed on its
own; the summary at the end is not needed, so that a bag can be read that was never closed. A chunk
that is damaged costs its messages, and the refused row that stands for them says so.

Source: https://mcap.dev/spec
"""

import struct
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from inertial.tables.errors import Refusal
from stages.formats.bag_chunks import unpacked
from stages.formats.bag_imu import Bag, Gap, Message, Topic, imu_table
from stages.formats.containers import Table
from stages.formats.limits import refuse_piece
from stages.formats.ros2_messages import understood

_MAGIC = b"\x89MCAP0\r\n"
_FOOTER, _SCHEMA, _CHANNEL, _MESSAGE, _CHUNK = 2, 3, 4, 5, 6  # kinds of records
_ENCODING = "cdr"  # how ROS 2 writes a message
_DAMAGE = (ValueError, EOFError, OSError, struct.error)


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The bag at `path` as a table of the messages of one topic.

    Raises
    ------
    Refusal
        where no topic is the IMU's or several may be, or a chunk claims to be too large
    """
    # In the summary a closed bag has its channels once more, so no chunk is unpacked for them.
    topics = _topics(path, inside=False) or _topics(path, inside=True)
    yield imu_table(path, layout, Bag(topics, partial(_messages, path), understood))


def _topics(path: Path, *, inside: bool) -> dict[int, Topic]:
    """What each channel carries, as stated outside the chunks or `inside` them."""
    kinds: dict[int, str] = {}
    topics: dict[int, Topic] = {}
    for kind, data in _walk(path, (_SCHEMA, _CHANNEL), inside=inside):
        content = BytesIO(data)
        if kind == _SCHEMA:
            (number,) = struct.unpack("<H", content.read(2))
            kinds[number] = _text(content)
        elif kind == _CHANNEL:
            number, schema = struct.unpack("<HH", content.read(4))
            name, encoding = _text(content), _text(content)
            known = kinds.get(schema, "of unknown kind")
            topics[number] = Topic(name, known if encoding == _ENCODING else f"in {encoding}")
    return topics


def _messages(path: Path) -> Iterator[Message | Gap]:
    for kind, data in _walk(path, (_MESSAGE,), inside=True):
        if isinstance(kind, Gap):
            yield kind
        elif len(data) < 22:
            yield Gap(f"a message of {len(data)} bytes, expected at least 22")
        else:
            channel, _, received, _ = struct.unpack_from("<HIQQ", data)
            yield Message(channel, received, data[22:])


def _walk(
    path: Path, wanted: tuple[int, ...], *, inside: bool
) -> Iterator[tuple[int | Gap, bytes]]:
    """The records of the `wanted` kinds with their data; a gap where some cannot be read."""
    size = path.stat().st_size
    with path.open("rb") as file:
        file.seek(len(_MAGIC))
        try:
            for kind, length in _records(file, size):
                if kind == _FOOTER:
                    return
                if kind == _CHUNK and inside:
                    refuse_piece(path, "a chunk", length)
                    yield from _in_chunk(path, file.read(length), wanted)
                elif kind in wanted:
                    refuse_piece(path, "a record", length)
                    yield kind, file.read(length)
        except _DAMAGE as error:
            yield Gap(f"the bag cannot be read any further: {error}"), b""
            return
    yield Gap("the bag was not closed: messages may be missing at its end"), b""


def _in_chunk(
    path: Path, chunk: bytes, wanted: tuple[int, ...]
) -> Iterator[tuple[int | Gap, bytes]]:
    try:
        content = BytesIO(chunk)
        _, _, size, checksum = struct.unpack("<QQQI", content.read(28))
        compression = _text(content)
        packed = content.read(*struct.unpack("<Q", content.read(8)))
        data = unpacked(path, packed, compression, size)
        if checksum and zlib.crc32(data) != checksum:
            raise ValueError("its checksum is wrong")
        records = BytesIO(data)
        for kind, length in _records(records, size):
            if kind in wanted:
                yield kind, records.read(length)
    except Refusal:
        raise
    except _DAMAGE as error:
        yield Gap(f"a chunk of messages is damaged: {error}"), b""


def _records(file: BinaryIO, size: int) -> Iterator[tuple[int, int]]:
    """Kind and length of the records from here on; each may be read before the next."""
    while (place := file.tell()) < size:
        head = file.read(9)
        if len(head) < 9:
            raise EOFError(f"the file ends inside the record at byte {place}")
        kind, length = struct.unpack("<BQ", head)
        end = place + 9 + length
        if end > size:
            raise EOFError(f"the record at byte {place} ends at byte {end}, the file at {size}")
        yield kind, length
        file.seek(end)


def _text(content: BinaryIO) -> str:
    (length,) = struct.unpack("<I", content.read(4))
    return content.read(length).decode()
