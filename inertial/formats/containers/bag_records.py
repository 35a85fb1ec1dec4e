"""The records of a bag from front to back, also where it was never closed or is damaged.

Messages lie in chunks of records, each compressed on its own. The readers of rosbags need the index
at the end and stop at the first damaged chunk; so its parsers of records are used here without the
index. A damaged chunk costs its messages, which one refused row represents.
"""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from io import BufferedReader, BytesIO, FileIO
from pathlib import Path
from typing import Any, BinaryIO

from inertial.formats.containers.imu_topic import Gap
from inertial.text.messages import _


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
