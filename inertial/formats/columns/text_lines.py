"""The lines of a text log: in chunks, and which of them are no data rows.

A line ends with LF, CRLF or CRCRLF, also mixed in one file; the last one may have no end. A lone CR
ends nothing: it is part of the text.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from io import BufferedReader
from pathlib import Path
from typing import Any, AnyStr

import numpy as np

from inertial.arrays import Booleans, Integers
from inertial.formats.account import HEADER, Account, RefusedLine, quoted

# ---- Chunks of whole lines, so that a log of any length passes through memory.

CHUNK_BYTES = 7 << 19
BYTE_ORDER_MARK = b"\xef\xbb\xbf"
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
    offsets: Integers  # byte in the file where a line begins
    lines: Integers  # number of a line in the file, from 1

    def __len__(self) -> int:
        return len(self.starts)

    def text(self, index: int) -> bytes:
        """The line `index` of the chunk without its line end."""
        return self.data[self.starts[index] : self.ends[index]]

    def begin_with(self, mark: bytes) -> Booleans:
        """Which lines begin with these bytes, (n,)."""
        characters = np.frombuffer(self.data + mark, np.uint8)
        there = self.ends - self.starts >= len(mark)
        for place, character in enumerate(mark):
            there &= characters[self.starts + place] == character
        return there

    def refused(self, index: int, reason: str) -> RefusedLine:
        """The line `index` of the chunk, refused for this reason."""
        line, offset, length = self.lines[index], self.offsets[index], self.lengths[index]
        return RefusedLine(int(line), int(offset), int(length), reason, quoted(self.text(index)))

    def part(self, kept: Booleans) -> "Chunk":
        """Those of its lines that are kept, (n,)."""
        if kept.all():
            return self
        characters = np.frombuffer(self.data, np.uint8)
        held = np.diff(self.starts, append=len(characters))
        starts = np.append(0, np.cumsum(held[kept]))[: np.count_nonzero(kept)]
        return Chunk(
            characters[np.repeat(kept, held)].tobytes(),
            starts,
            starts + (self.ends - self.starts)[kept],
            self.lengths[kept],
            self.offsets[kept],
            self.lines[kept],
        )


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
    returns = np.zeros(len(ends), np.int64)
    for _each in range(
        2
    ):  # CR CR LF: a program that writes CRLF, on a system that writes it for LF
        at = ends - returns
        is_return = characters[np.maximum(at - 1, 0)] == ord("\r")
        returns += is_return & (at > starts)
    lines = line + np.arange(len(starts))
    return Chunk(data, starts, ends - returns, stops - starts, offset + starts, lines)


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
        np.array([offset]),
        np.array([line]),
    )


# ---- Header and comments, which come before the rows or among them.


@dataclass(frozen=True)
class RowLines:
    """The lines of a chunk that may be data rows, and what became of the others."""

    chunk: Chunk
    account: Account = field(default_factory=Account)
    refused: list[RefusedLine] = field(default_factory=list)
    lost: Integers | int = 0  # refused rows before each line, (n,)
    all_lost: int = 0  # refused rows in all


class HeaderLines:
    """Separates header and comments from the rows of a log, chunk after chunk.

    `names`: the line that may hold the names of the columns, by `naming_line` of the header
    lines; where none are stated, of the comments before the first row.
    """

    def __init__(self, layout: Mapping[str, Any]) -> None:
        self.names = b""
        self._last: list[bytes] = []  # lines of the header
        self._delimiter = str(layout["delimiter"]).encode() if layout.get("delimiter") else None
        self._comment = str(layout.get("comment") or "").encode()
        self._stated = int(layout.get("header_lines") or 0)
        self._left = self._stated
        self._begun = False

    def rows_of(self, chunk: Chunk) -> RowLines:
        """The lines of the next chunk that are neither header nor comment."""
        if self._begun and not (self._comment and self._comment in chunk.data):
            return RowLines(chunk)
        comments = np.zeros(len(chunk), bool)
        if self._comment:
            comments = chunk.begin_with(self._comment)
            if chunk.lines[0] == 1 and chunk.text(0).startswith(BYTE_ORDER_MARK + self._comment):
                comments[0] = True
        header = np.flatnonzero(~comments)[: self._left]
        self._left -= len(header)
        others = comments.copy()
        others[header] = True
        if not self._begun:
            rows = np.flatnonzero(~others)
            self._begun = bool(len(rows))
            before = np.flatnonzero(comments[: rows[0]] if len(rows) else comments)
            named = header if self._stated else before
            if len(named):
                self._last += [chunk.text(int(line)) for line in named[-4:]]
                self.names = naming_line(self._last, self._delimiter)
        account = Account()
        account.add_all(HEADER, "", chunk.lengths[others])
        return RowLines(chunk.part(~others), account)


def naming_line(header: Sequence[AnyStr], delimiter: AnyStr | None) -> AnyStr:
    """The last line of a header; or the one before, where the last repeats a field, as units do.

    Lines of blanks do not count.
    """
    header = [line for line in header if line.strip()] or header
    if len(header) > 1:
        before, last = ([text.strip() for text in line.split(delimiter)] for line in header[-2:])
        if len(set(before)) == len(before) == len(last) > len(set(last)):
            return header[-2]
    return header[-1]


# ---- Rows whose fields carry their names, as many a serial port prints them
#
# `ax:123 ay:-4`, `gx = 0.1, gy = 0.2` and one JSON object a line: {"t": 0.01, "ax": 9.8}. The
# names, quotation marks and braces become blanks, so that every byte stays in its place. The T of a
# date begins no name.

_NAME = rb"[A-Za-z_][^\s:=,;\"]*(?:[ ][A-Za-z_(\[][^\s:=,;\"]*)*"
_FIELD_NAME = re.compile(rb"(?<![\w.+-])\"?(" + _NAME + rb")\"?[ \t]*[:=]")
_MARKS = bytes.maketrans(b'"{}[]', b"     ")


class LabelledLines:
    """The lines of a log without the names in its fields.

    `names`: a header of those of the first row with three or more, separated as its fields are.
    """

    def __init__(self, layout: Mapping[str, Any]) -> None:
        self.names = b""
        self._header = HeaderLines(layout)
        self._between = str(layout.get("delimiter") or " ").encode()

    def rows_of(self, chunk: Chunk) -> RowLines:
        """The lines of the next chunk that are neither header nor comment."""
        lines = self._header.rows_of(chunk)
        if not self.names:
            found = (names_in(lines.chunk.text(i)) for i in range(len(lines.chunk)))
            names = next((own for own in found if len(own) >= 3), [])
            self.names = self._between.join(name.replace(self._between, b"_") for name in names)
        bare = without_names(lines.chunk.data)
        return replace(lines, chunk=replace(lines.chunk, data=bare))


def names_in(line: bytes) -> list[bytes]:
    """The names of the fields of a line."""
    return _FIELD_NAME.findall(line)


def without_names(text: bytes) -> bytes:
    """The same with blanks in their place."""
    return _FIELD_NAME.sub(lambda found: b" " * len(found[0]), text).translate(_MARKS)
