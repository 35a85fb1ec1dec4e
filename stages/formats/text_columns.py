"""A log of columns of text: some header lines, then one data row per sample.

The fields of a row stand between delimiters, by default any white space; blanks around a value do
not count. Numbers come out as they stand in the file. A row is refused that has not as many fields
as the others, or no finite number where the layout wants one.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from pyarrow import csv

from stages.formats.account import (
    BLANK,
    DECODED,
    HEADER,
    NOT_SELECTED,
    REFUSED,
    Account,
    quoted,
    refused_line,
)
from stages.formats.column_layout import Column, ColumnLayout, column_layout
from stages.formats.fields import Field, TextField
from stages.formats.pieces import LONGEST_LINE, PIECE_BYTES, Integers, Piece, pieces
from stages.formats.plain_rows import BETWEEN, plain_rows
from stages.formats.rows import Place, Reading, sort_rows

FIRST = 1000  # rows by which the number of fields is told


def read(
    path: Path, layout: Mapping[str, Any], piece_bytes: int = PIECE_BYTES
) -> Iterator[Reading]:
    """The log at `path` in this layout, piece by piece.

    Raises
    ------
    Refusal
        where the layout names a column that the header has not, or has twice
    """
    text = layout.get("delimiter")
    delimiter = None if text is None else str(text).encode()
    header_lines = int(layout.get("header_lines") or 0)
    names, lengths = _beginning(path, delimiter, header_lines, piece_bytes)
    # A file without data rows has no columns that could be missed.
    columns = column_layout(layout if lengths else {}, names, path.name)
    fields = len(names) if columns.by_name else _usual_length(columns, lengths)

    records = 0
    for piece in pieces(path, piece_bytes):
        lines = _sort_lines(piece, delimiter, header_lines, fields)
        yield _read_rows(piece, lines, columns, fields, records)
        records += lines.data


# ---- lines


@dataclass(frozen=True)
class _Lines:
    """The lines of a piece, told apart."""

    data: int  # number of data rows, refused ones counted
    rows: bytes  # the n whole ones, cut into fields, each a line
    indices: Integers  # which lines of the piece these are, (n,)
    numbers: Integers  # which data rows of the piece, (n,)
    reasons: dict[int, str]  # why the others are refused, by index
    account: Account  # of header and blank lines


def _beginning(
    path: Path, delimiter: bytes | None, header_lines: int, piece_bytes: int
) -> tuple[list[str], Counter[int]]:
    """The names in the last header line, and how often the first rows have how many fields."""
    names: list[str] = []
    lengths: Counter[int] = Counter()
    for piece in pieces(path, piece_bytes):
        for index, line in enumerate(piece.lines.tolist()):
            text = piece.text(index)
            if line == header_lines:
                header = _cut(text, delimiter).decode("utf-8-sig", "backslashreplace")
                names = [name.strip() for name in header.split(BETWEEN.decode())]
            elif line > header_lines and text.strip():
                lengths[_length(_cut(text, delimiter))] += 1
                if lengths.total() == FIRST:
                    return names, lengths
        if lengths:
            break
    return names, lengths


def _usual_length(columns: ColumnLayout, lengths: Mapping[int, int]) -> int:
    """The number of fields that most rows have which have the wanted columns at all."""
    needed = max((column.index + 1 for column in columns.all), default=1)
    enough = [length for length in lengths if length >= needed]
    return max(enough, key=lambda length: lengths[length], default=needed)


def _sort_lines(piece: Piece, delimiter: bytes | None, header_lines: int, fields: int) -> _Lines:
    """All lines of a piece; those that are not plain rows are looked at one by one."""
    header = min(max(header_lines + 1 - piece.first_line, 0), len(piece.starts))
    is_row, rows = plain_rows(piece, header, delimiter, fields)
    is_data = is_row.copy()
    others: dict[int, bytes] = {}
    account, reasons = Account(), {}
    for index in np.flatnonzero(~is_row).tolist():
        text, length = piece.text(index), int(piece.lengths[index])
        if index < header:
            account.add(HEADER, "", 1, length)
        elif not text.strip() and length <= LONGEST_LINE:
            account.add(BLANK, "", 1, length)
        else:
            is_data[index] = True
            row = _cut(text, delimiter)
            if reason := _why_no_row(text, row, length, fields):
                reasons[index] = reason
            else:
                others[index] = row
    if others:
        plain = zip(np.flatnonzero(is_row).tolist(), rows.split(b"\n"), strict=False)
        rows = b"\n".join(row for _, row in sorted([*plain, *others.items()]))
        is_row[list(others)] = True
    indices = np.flatnonzero(is_row)
    numbers = np.cumsum(is_data)[indices] - 1
    return _Lines(int(is_data.sum()), rows, indices, numbers, reasons, account)


def _cut(text: bytes, delimiter: bytes | None) -> bytes:
    if delimiter is None:
        return BETWEEN.join(text.split())
    return text.replace(delimiter, BETWEEN)


def _length(row: bytes) -> int:
    return row.count(BETWEEN) + 1


def _why_no_row(text: bytes, row: bytes, length: int, fields: int) -> str:
    """Why a line is no data row; empty where it is one."""
    if length > LONGEST_LINE:
        return f"{length} bytes without a line end, expected at most {LONGEST_LINE}"
    if b"\r" in text:
        return "a carriage return inside the line, expected LF or CRLF at its end"
    if not text.isascii():
        try:
            text.decode()
        except UnicodeDecodeError as error:
            return f"byte '{quoted(text[error.start : error.end])}', expected text in UTF-8"
    if _length(row) != fields:
        return f"{_length(row)} fields, expected {fields}"
    return ""


# ---- rows


def _read_rows(
    piece: Piece, lines: _Lines, columns: ColumnLayout, fields: int, records: int
) -> Reading:
    """The data rows of `piece`, `records` rows being before it."""
    place = Place(records + lines.numbers, piece.offsets[lines.indices], piece.lines[lines.indices])
    found = sort_rows(columns, _fields(lines.rows, columns.all, fields), place)
    indices = lines.indices
    reasons = dict(lines.reasons)
    reasons |= {int(indices[row]): reason for row, reason in found.reasons.items()}
    account = lines.account
    account.add_all(DECODED, "", piece.lengths[indices[found.taken]])
    account.add_all(NOT_SELECTED, "", piece.lengths[indices[found.not_selected]])
    lost = sorted(reasons)
    account.add_all(REFUSED, "", piece.lengths[lost])
    refused = [refused_line(piece, index, reasons[index]) for index in lost]
    return Reading(found.rows, refused, account)


def _fields(rows: bytes, columns: Sequence[Column], fields: int) -> dict[int, Field]:
    """The columns by index, blanks around the texts left out."""
    indices = sorted({column.index for column in columns})
    if not rows or not indices:
        return {index: TextField(pa.chunked_array([], pa.string())) for index in indices}
    table = csv.read_csv(
        pa.BufferReader(rows),
        csv.ReadOptions(
            column_names=[str(index) for index in range(fields)], block_size=2 * LONGEST_LINE
        ),
        csv.ParseOptions(
            delimiter=BETWEEN.decode(),
            quote_char=False,
            double_quote=False,
            ignore_empty_lines=False,
        ),
        csv.ConvertOptions(
            include_columns=[str(index) for index in indices],
            column_types={str(index): pa.string() for index in indices},
            null_values=[],
        ),
    )
    return {index: TextField(pc.utf8_trim_whitespace(table[str(index)])) for index in indices}
