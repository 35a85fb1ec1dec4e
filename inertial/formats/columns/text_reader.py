"""Columns of text: whole chunks by pyarrow, lines that it refuses one by one."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import csv

from inertial.formats.account import (
    BLANK,
    DECODED,
    HEADER,
    NOT_SELECTED,
    REFUSED,
    Account,
    Integers,
    RefusedLine,
    quoted,
)
from inertial.formats.arrow_arrays import numbers_of
from inertial.formats.columns.column_layout import ColumnLayout, column_layout
from inertial.formats.columns.column_values import ColumnValues, NumberValues, TextValues
from inertial.formats.columns.data_rows import Place, Reading, sort_rows
from inertial.text.messages import _

# ---- A text log in chunks of whole lines, so that a log of any length passes through memory.
#
# A line ends with LF or CRLF, also mixed in one file; the last one may have no end. A lone CR ends
# nothing: it is part of the text.

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


# ---- Reader of a text log of columns: some header lines, then one data row per sample.
#
# The fields of a row stand between delimiters, by default any white space; blanks around a value
# do not count. Numbers have the units of the file. A row is refused that has another number of
# fields than the others, or no finite number where the layout requires one.
#
# pyarrow parses a chunk of lines at once. Lines with another number of fields, and chunks that it
# cannot parse as the layout requires, are examined line by line.

FIRST_ROWS = 1000  # that determine the number of fields
SEPARATOR = b"\x1f"  # between the fields of rows that are examined one by one


def read(
    path: Path, layout: Mapping[str, Any], chunk_bytes: int = CHUNK_BYTES
) -> Iterator[Reading]:
    """The log at `path` in this layout, chunk by chunk.

    Raises
    ------
    Refusal
        where the layout names a column that is missing in the header, or is there twice
    """
    text = layout.get("delimiter")
    delimiter = None if text is None else str(text).encode()
    header_lines = int(layout.get("header_lines") or 0)
    names, lengths = _beginning(path, delimiter, header_lines, chunk_bytes)
    # A file without data rows lacks no columns.
    columns = column_layout(layout if lengths else {}, names, path.name)
    fields = len(names) if columns.by_name else _usual_length(columns, lengths)

    records = 0
    for chunk in text_chunks(path, chunk_bytes):
        header = min(max(header_lines + 1 - chunk.first_line, 0), len(chunk.starts))
        rows = _rows(chunk, header, delimiter, columns, fields)
        yield _reading(chunk, header, rows, columns, records)
        records += len(rows.lines) + len(rows.reasons)


def _beginning(
    path: Path, delimiter: bytes | None, header_lines: int, chunk_bytes: int
) -> tuple[list[str], Counter[int]]:
    """The names in the last header line, and how many of the first rows have how many fields."""
    names: list[str] = []
    lengths: Counter[int] = Counter()
    for chunk in text_chunks(path, chunk_bytes):
        for index, line in enumerate(chunk.lines.tolist()):
            text = chunk.text(index)
            if line == header_lines:
                header = _separated(text, delimiter).decode("utf-8-sig", "backslashreplace")
                names = [name.strip() for name in header.split(SEPARATOR.decode())]
            elif line > header_lines and text.strip():
                lengths[_length(_separated(text, delimiter))] += 1
                if lengths.total() == FIRST_ROWS:
                    return names, lengths
        if lengths:
            break
    return names, lengths


def _usual_length(columns: ColumnLayout, lengths: Mapping[int, int]) -> int:
    """The most frequent number of fields among rows that have the required columns."""
    needed = max((column.index + 1 for column in columns.all), default=1)
    enough = [length for length in lengths if length >= needed]
    return max(enough, key=lambda length: lengths[length], default=needed)


@dataclass(frozen=True)
class _Rows:
    """The data rows of a chunk."""

    columns: Mapping[int, ColumnValues]  # the required columns of the n intact rows, by index
    lines: Integers  # which lines of the chunk these are, (n,)
    reasons: dict[int, str]  # why other lines are refused, by line of the chunk
    blank: list[int]  # lines of the chunk


def _reading(
    chunk: Chunk, header: int, rows: _Rows, columns: ColumnLayout, records: int
) -> Reading:
    """The samples in the rows of `chunk`, with `records` rows before it."""
    is_row = np.zeros(len(chunk.starts), bool)
    is_row[rows.lines] = True
    is_row[list(rows.reasons)] = True
    numbers = records - 1 + np.cumsum(is_row)[rows.lines]
    place = Place(numbers, chunk.offsets[rows.lines], chunk.lines[rows.lines])
    rows_sorted = sort_rows(columns, rows.columns, place)
    invalid = {int(rows.lines[row]): reason for row, reason in rows_sorted.reasons.items()}
    reasons = rows.reasons | invalid
    account = Account()
    account.add_all(HEADER, "", chunk.lengths[:header])
    account.add_all(BLANK, "", chunk.lengths[rows.blank])
    account.add_all(DECODED, "", chunk.lengths[rows.lines[rows_sorted.taken]])
    account.add_all(NOT_SELECTED, "", chunk.lengths[rows.lines[rows_sorted.not_selected]])
    account.add_all(REFUSED, "", chunk.lengths[sorted(reasons)])
    refused = [
        RefusedLine(
            line=chunk.first_line + index,
            offset=chunk.offset + int(chunk.starts[index]),
            bytes=int(chunk.lengths[index]),
            reason=reasons[index],
            text=quoted(chunk.text(index)),
        )
        for index in sorted(reasons)
    ]
    return Reading(rows_sorted.samples, refused, account)


def _rows(
    chunk: Chunk, header: int, delimiter: bytes | None, columns: ColumnLayout, fields: int
) -> _Rows:
    """The rows of `chunk` behind `header` lines."""
    if columns.all and header < len(chunk.starts) and _is_regular(chunk, header):
        rows = _parsed(chunk, header, delimiter, columns, fields)
        if rows is not None:
            return rows
    return _examined(chunk, range(header, len(chunk.starts)), delimiter, columns, fields)


# ---- chunk by chunk


def _is_regular(chunk: Chunk, header: int) -> bool:
    """Whether lines and fields are to pyarrow what they are to this format."""
    data = chunk.data
    if SEPARATOR in data:
        return False
    if b"\r" in data and data.count(b"\r") != data.count(b"\r\n"):
        return False
    if chunk.lengths[header:].max() > MAX_LINE_BYTES:
        return False
    try:
        return data.isascii() or bool(data.decode())
    except UnicodeDecodeError:
        return False


def _parsed(
    chunk: Chunk, header: int, delimiter: bytes | None, columns: ColumnLayout, fields: int
) -> _Rows | None:
    """The rows as pyarrow parses them; None where they must be examined line by line."""
    data, between = _delimited(chunk.data[chunk.starts[header] :], delimiter)
    feeds = np.append(np.flatnonzero(np.frombuffer(data, np.uint8) == ord("\n")), len(data))
    filled = header + np.flatnonzero(np.diff(feeds, prepend=-1) > 1)
    found = None
    if columns.number_indices:
        found = _table(data, between, fields, columns, pa.float64())
    # Only numbers tell a row from a line of blanks, where these are delimiters or the only field.
    if found is None and (delimiter is None or (fields > 1 and delimiter.strip())):
        found = _table(data, between, fields, columns, pa.string())
    if found is None:
        return None
    values, count, others = found
    lines = np.delete(filled, others)
    is_other = np.ones(len(chunk.starts), bool)
    is_other[:header] = is_other[lines] = False
    others = np.flatnonzero(is_other).tolist()
    examined = _examined(chunk, others, delimiter, columns, fields)
    if len(lines) != count or len(examined.lines):
        return None
    return _Rows(values, lines, examined.reasons, examined.blank)


def _delimited(data: bytes, delimiter: bytes | None) -> tuple[bytes, str]:
    """The same lines with fields between single characters, and that character."""
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n")
    if delimiter is not None:
        if len(delimiter) == 1:
            return data, delimiter.decode()
        return data.replace(delimiter, SEPARATOR), SEPARATOR.decode()
    data = data.translate(bytes.maketrans(b"\t\v\f", b"   "))
    characters = np.frombuffer(data, np.uint8)
    blank = characters == ord(" ")
    superfluous = blank[:-1] & (blank[1:] | (characters[1:] == ord("\n")))
    if superfluous.any():
        data = characters[np.append(~superfluous, True)].tobytes()
    return data.replace(b"\n ", b"\n").strip(b" "), " "


def _table(
    data: bytes, between: str, fields: int, columns: ColumnLayout, number_type: pa.DataType
) -> tuple[dict[int, ColumnValues], int, list[int]] | None:
    """The columns by index, the number of rows, and which filled lines are none, from 0.

    None where a number is required and there is no finite one of `number_type`.
    """
    others: list[int] = []

    def skip(row: csv.InvalidRow) -> str:
        others.append(row.number - 1)
        return "skip"

    types = dict.fromkeys(columns.number_indices, number_type)
    types |= dict.fromkeys(columns.text_indices, pa.string())
    try:
        table = csv.read_csv(
            pa.BufferReader(data),
            csv.ReadOptions(
                column_names=[str(index) for index in range(fields)],
                block_size=len(data) + 1,
                use_threads=False,
            ),
            csv.ParseOptions(
                delimiter=between, quote_char=False, double_quote=False, invalid_row_handler=skip
            ),
            csv.ConvertOptions(
                include_columns=[str(index) for index in types],
                column_types={str(index): kind for index, kind in types.items()},
                null_values=[],
            ),
        )
    except pa.ArrowInvalid:
        return None
    values: dict[int, ColumnValues] = {}
    for index, kind in types.items():
        column = table[str(index)]
        if kind == pa.string():
            values[index] = TextValues(pc.utf8_trim_whitespace(column))
        else:
            values[index] = NumberValues(numbers_of(column))
            if not np.isfinite(values[index].numbers()).all():
                return None
    return values, table.num_rows, others


# ---- line by line


def _examined(
    chunk: Chunk,
    indices: Sequence[int],
    delimiter: bytes | None,
    columns: ColumnLayout,
    fields: int,
) -> _Rows:
    """The rows among some lines of the chunk."""
    rows: dict[int, bytes] = {}
    reasons: dict[int, str] = {}
    blank: list[int] = []
    for index in indices:
        text, length = chunk.text(index), int(chunk.lengths[index])
        if not text.strip() and length <= MAX_LINE_BYTES:
            blank.append(index)
            continue
        row = _separated(text, delimiter)
        if reason := _why_not_a_row(text, row, length, fields):
            reasons[index] = reason
        else:
            rows[index] = row
    values: dict[int, ColumnValues] = {}
    if rows and columns.all:
        data = b"\n".join(rows.values())
        found = _table(data, SEPARATOR.decode(), fields, columns, pa.string())
        assert found is not None
        values = found[0]
    elif columns.all:
        none = TextValues(pa.chunked_array([], pa.string()))
        values = {column.index: none for column in columns.all}
    return _Rows(values, np.array(list(rows), np.int64), reasons, blank)


def _separated(text: bytes, delimiter: bytes | None) -> bytes:
    """The fields of a line with `SEPARATOR` between them."""
    if delimiter is None:
        return SEPARATOR.join(text.split())
    return text.replace(delimiter, SEPARATOR)


def _length(row: bytes) -> int:
    return row.count(SEPARATOR) + 1


def _why_not_a_row(text: bytes, row: bytes, length: int, fields: int) -> str:
    """Why a line is not a data row; empty where it is one."""
    if length > MAX_LINE_BYTES:
        return _(
            "{length} bytes without a line end, expected at most {max_line_bytes}",
            length=length,
            max_line_bytes=MAX_LINE_BYTES,
        )
    if b"\r" in text:
        return _("a carriage return inside the line, expected LF or CRLF at its end")
    if not text.isascii():
        try:
            text.decode()
        except UnicodeDecodeError as error:
            return _(
                "byte '{text}', expected text in UTF-8", text=quoted(text[error.start : error.end])
            )
    if _length(row) != fields:
        return _("{row} fields, expected {fields}", row=_length(row), fields=fields)
    return ""
