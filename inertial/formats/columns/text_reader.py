"""Reader of a text log of columns: one data row per sample.

The fields of a row stand between delimiters, by default any white space; blanks and quotation marks
around a value do not count. Numbers have the units of the file. A row is refused that has another
number of fields than the others, or no finite number where the layout requires one. Where every
row ends with a delimiter the nothing after it is no field.

pyarrow parses a chunk of lines at once. Lines with another number of fields, and chunks that it
cannot parse as the layout requires, are examined line by line.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import csv

from inertial.arrays import Integers
from inertial.formats.account import BLANK, DECODED, NOT_SELECTED, REFUSED, quoted
from inertial.formats.arrow_arrays import numbers_of
from inertial.formats.columns import vectornav_lines
from inertial.formats.columns.column_layout import (
    ColumnLayout,
    column_layout,
    names_in_header,
)
from inertial.formats.columns.column_values import ColumnValues, NumberValues, TextValues
from inertial.formats.columns.data_rows import Place, Reading, sort_rows
from inertial.formats.columns.text_lines import (
    CHUNK_BYTES,
    MAX_LINE_BYTES,
    Chunk,
    HeaderLines,
    LabelledLines,
    RowLines,
    text_chunks,
)
from inertial.text.messages import _

FIRST_ROWS = 1000  # that determine the number of fields
QUOTE = b'"'
SEPARATOR = b"\x1f"  # between the fields of rows that are examined one by one


class _Sorter(Protocol):
    """Separates the lines that may be rows from the others, chunk after chunk."""

    names: bytes

    def rows_of(self, chunk: Chunk) -> RowLines: ...


def _sorter(layout: Mapping[str, Any]) -> _Sorter:
    if "message" in layout:
        return vectornav_lines.MessageLines(layout)
    if layout.get("labelled"):
        return LabelledLines(layout)
    return HeaderLines(layout)


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
    names, lengths, closed = _beginning(path, layout, delimiter, chunk_bytes)
    # A file without data rows lacks no columns.
    columns = column_layout(layout if lengths else {}, names, path.name)
    fields = _usual_length(columns, lengths)
    if columns.by_name and not (fields == len(names) + 1 and closed[fields] == lengths[fields] > 0):
        fields = len(names)
    if columns.by_name:  # then numbers are of these columns too
        columns = column_layout(layout, names, path.name, most=fields)

    records = 0
    sorter = _sorter(layout)
    for chunk in text_chunks(path, chunk_bytes):
        lines = _unquoted(sorter.rows_of(chunk))
        rows = _rows(lines.chunk, delimiter, columns, fields)
        yield _reading(lines, rows, columns, records)
        records += len(rows.lines) + len(rows.reasons) + lines.all_lost


def _unquoted(lines: RowLines) -> RowLines:
    """The same with blanks for quotation marks, which some programs write around numbers."""
    if QUOTE not in lines.chunk.data:
        return lines
    return replace(lines, chunk=replace(lines.chunk, data=lines.chunk.data.replace(QUOTE, b" ")))


def _beginning(
    path: Path, layout: Mapping[str, Any], delimiter: bytes | None, chunk_bytes: int
) -> tuple[list[str], Counter[int], Counter[int]]:
    """The names of the columns, how many of the first rows have how many fields, the last empty."""
    lengths: Counter[int] = Counter()
    closed: Counter[int] = Counter()
    sorter = _sorter(layout)
    for chunk in text_chunks(path, chunk_bytes):
        rows = sorter.rows_of(chunk).chunk
        for index in range(min(len(rows), FIRST_ROWS)):
            if rows.text(index).strip():
                row = _separated(rows.text(index), delimiter)
                lengths[_length(row)] += 1
                closed[_length(row)] += not row.rpartition(SEPARATOR)[2].strip()
        if lengths:
            break
    return _names(sorter.names, delimiter), lengths, closed


def _names(header: bytes, delimiter: bytes | None) -> list[str]:
    """The names of the columns in a line of the header."""
    try:
        text = header.decode("utf-8-sig")
    except UnicodeDecodeError:  # of a program for Windows
        text = header.decode("cp1252", "backslashreplace")
    return names_in_header(text, None if delimiter is None else delimiter.decode())


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


def _reading(lines: RowLines, rows: _Rows, columns: ColumnLayout, records: int) -> Reading:
    """The samples in the rows of a chunk, with `records` rows before it."""
    chunk, account = lines.chunk, lines.account
    is_row = np.zeros(len(chunk), bool)
    is_row[rows.lines] = True
    is_row[list(rows.reasons)] = True
    row_numbers: Integers = np.cumsum(is_row, dtype=np.int64) + lines.lost
    numbers = records - 1 + row_numbers[rows.lines]
    place = Place(numbers, chunk.offsets[rows.lines], chunk.lines[rows.lines])
    rows_sorted = sort_rows(columns, rows.columns, place)
    invalid = {int(rows.lines[row]): reason for row, reason in rows_sorted.reasons.items()}
    reasons = rows.reasons | invalid
    account.add_all(BLANK, "", chunk.lengths[rows.blank])
    account.add_all(DECODED, "", chunk.lengths[rows.lines[rows_sorted.taken]])
    account.add_all(NOT_SELECTED, "", chunk.lengths[rows.lines[rows_sorted.not_selected]])
    account.add_all(REFUSED, "", chunk.lengths[sorted(reasons)])
    refused = [chunk.refused(index, reason) for index, reason in reasons.items()]
    refused = sorted(lines.refused + refused, key=lambda line: line.line)
    return Reading(rows_sorted.samples, refused, account)


def _rows(chunk: Chunk, delimiter: bytes | None, columns: ColumnLayout, fields: int) -> _Rows:
    """The rows of `chunk`."""
    if columns.all and len(chunk) and _is_regular(chunk):
        rows = _parsed(chunk, delimiter, columns, fields)
        if rows is not None:
            return rows
    return _examined(chunk, range(len(chunk)), delimiter, columns, fields)


# ---- chunk by chunk


def _is_regular(chunk: Chunk) -> bool:
    """Whether lines and fields are to pyarrow what they are to this format."""
    data = chunk.data
    if SEPARATOR in data:
        return False
    if b"\r" in data and data.count(b"\r") != data.count(b"\r\n"):
        return False
    if chunk.lengths.max() > MAX_LINE_BYTES:
        return False
    try:
        return data.isascii() or bool(data.decode())
    except UnicodeDecodeError:
        return False


def _parsed(
    chunk: Chunk, delimiter: bytes | None, columns: ColumnLayout, fields: int
) -> _Rows | None:
    """The rows as pyarrow parses them; None where they must be examined line by line."""
    data, between = _delimited(chunk.data, delimiter)
    feeds = np.append(np.flatnonzero(np.frombuffer(data, np.uint8) == ord("\n")), len(data))
    filled = np.flatnonzero(np.diff(feeds, prepend=-1) > 1)
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
    is_other = np.ones(len(chunk), bool)
    is_other[lines] = False
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
                decimal_point=columns.decimal,
            ),
        )
    except pa.ArrowInvalid:
        return None
    values: dict[int, ColumnValues] = {}
    for index, kind in types.items():
        column = table[str(index)]
        if kind == pa.string():
            values[index] = TextValues(pc.utf8_trim_whitespace(column), columns.decimal)
        else:
            values[index] = NumberValues(numbers_of(column))
            if not np.isfinite(values[index].numbers()).all():
                return None  # among them an infinite or unknown temperature, which texts tell apart
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
