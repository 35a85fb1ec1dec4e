"""A text log in chunks of whole lines, so that a log of any length passes through memory.

A line ends with LF or CRLF, also mixed in one file; the last one may have no end. A lone CR ends
nothing: it is part of the text.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path

import numpy as np

from inertial.formats.account import Integers

CHUNK_BYTES = 7 << 19
MAX_LINE_BYTES = 1 << 20  # longer is no line of a log, such as the zeros after a crash


@dataclass(frozen=True)
class Chunk:
    """Some consecutive lines of a log; the arrays have one entry per line, (n,).

    Of a line longer than `MAX_LINE_BYTES`, `data` may hold only the beginning; `lengths` has
    its true length. The reader refuses it.
    """

    data: bytes
    starts: Integers  # byte in `data` where a line begins
    ends: Integers  # byte in `data` after its text, the line end left out
    lengths: Integers  # byte in the file, with the line end
    offset: int  # byte in the file where `data` begins
    first_line: int  # number of the first line, from 1

    @property
    def offsets(self) -> Integers:
        """Where each line begins in the file, byte."""
        return self.offset + self.starts

    @property
    def lines(self) -> Integers:
        """Number of each line in the file, from 1."""
        return self.first_line + np.arange(len(self.starts))

    def text(self, index: int) -> bytes:
        """The line `index` of the chunk without its line end."""
        return self.data[self.starts[index] : self.ends[index]]


def text_chunks(path: Path, size: int = CHUNK_BYTES) -> Iterator[Chunk]:
    """The lines of the file at `path`, about `size` bytes at a time.

    No more than the rest of a line and one reading of `size` bytes are held.
    """
    offset, line = 0, 1
    with path.open("rb") as file:
        rest = b""
        while read := file.read(size):
            data = rest + read
            end = data.rfind(b"\n") + 1
            if end == 0 and len(data) > MAX_LINE_BYTES:
                length = len(data) + _skip_to_line_end(file, size)
                yield _overlong(data[:MAX_LINE_BYTES], length, offset, line)
                offset, line, rest = offset + length, line + 1, b""
                continue
            if end:
                chunk = _cut(data[:end], offset, line)
                yield chunk
                offset, line = offset + end, line + len(chunk.starts)
            rest = data[end:]
        if rest:
            yield _cut(rest, offset, line)


def _cut(data: bytes, offset: int, line: int) -> Chunk:
    characters = np.frombuffer(data, np.uint8)
    feeds = np.flatnonzero(characters == ord("\n"))
    stops, ends = feeds + 1, feeds
    if not data.endswith(b"\n"):
        stops, ends = np.append(stops, len(data)), np.append(ends, len(data))
    starts = np.concatenate([[0], stops[:-1]])
    before_the_end = characters[np.maximum(ends - 1, 0)]
    returns = (before_the_end == ord("\r")) & (ends > starts)
    return Chunk(data, starts, ends - returns, stops - starts, offset, line)


def _skip_to_line_end(file: BufferedReader, size: int) -> int:
    """Read on past the next line end; the number of bytes read."""
    skipped = 0
    while read := file.readline(size):
        skipped += len(read)
        if read.endswith(b"\n"):
            break
    return skipped


def _overlong(beginning: bytes, length: int, offset: int, line: int) -> Chunk:
    return Chunk(
        beginning,
        np.array([0]),
        np.array([len(beginning)]),
        np.array([length]),
        offset,
        line,
    )
