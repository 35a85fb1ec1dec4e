"""A log of columns of text: some header lines, then one data row per sample.

The fields of a row stand between delimiters, by default any white space; blanks around a value do
not count. Numbers come out as they stand in the file. A row is refused that has not as many fields
as the others, or no finite number where the layout wants one.
"""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray
from pyarrow import csv

from stages.formats.account import (
    BLANK,
    DECODED,
    HEADER,
    NOT_SELECTED,
    REFUSED,
    Account,
    RefusedLine,
    quoted,
    refused_line,
)
from stages.formats.arrow_arrays import numbers_of
from stages.formats.column_layout import Column, ColumnLayout, Triad, column_layout
from stages.formats.pieces import LONGEST_LINE, PIECE_BYTES, Integers, Piece, pieces

Reals = NDArray[np.float64]
Truths = NDArray[np.bool_]

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_BETWEEN = b"\x1f"  # put between the fields of every row: ASCII's own unit separator


@dataclass(frozen=True)
class Rows:
    """What n data rows say; NaN where a value is not recorded, None where none ever is."""

    record: Integers  # number among the data rows of the log, refused ones counted, (n,)
    offset: Integers  # byte in the file where the line begins, (n,)
    line: Integers  # number of the line, from 1, (n,)
    ticks: Reals | None  # time; `ticks_per_second` of the layout tells the unit, (n,)
    mean_of: Reals | None  # number of samples that the row is the mean of, (n,)
    accelerometer: Reals  # x, y, z, as they stand in the file, (n, 3)
    gyro: Reals  # likewise
    table_angle: Reals | None  # as it stands in the file, (n,)
    temperature: Reals | None  # likewise
    label: list[str] | None  # "column=value; …" of the columns that the plan selects by, (n,)


@dataclass(frozen=True)
class Reading:
    """What a piece of the log holds."""

    records: Rows
    refused: list[RefusedLine]
    account: Account


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
    rows: list[bytes]  # the whole ones, cut into fields
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
        for line, text in enumerate(piece.texts(), start=piece.first_line):
            if line == header_lines:
                header = _cut(text, delimiter).decode("utf-8-sig", "backslashreplace")
                names = [name.strip() for name in header.split(_BETWEEN.decode())]
            elif line > header_lines and text.strip():
                lengths[_length(_cut(text, delimiter))] += 1
        if lengths:
            break
    return names, lengths


def _usual_length(columns: ColumnLayout, lengths: Mapping[int, int]) -> int:
    """The number of fields that most rows have which have the wanted columns at all."""
    needed = max((column.index + 1 for column in columns.all), default=1)
    enough = [length for length in lengths if length >= needed]
    return max(enough, key=lambda length: lengths[length], default=needed)


def _sort_lines(piece: Piece, delimiter: bytes | None, header_lines: int, fields: int) -> _Lines:
    account = Account()
    data, rows, indices, numbers, reasons = 0, [], [], [], {}
    lengths = piece.lengths.tolist()
    for index, text in enumerate(piece.texts()):
        if piece.first_line + index <= header_lines:
            account.add(HEADER, "", 1, lengths[index])
            continue
        if not text.strip() and lengths[index] <= LONGEST_LINE:
            account.add(BLANK, "", 1, lengths[index])
            continue
        row = _cut(text, delimiter)
        if reason := _why_no_row(text, row, lengths[index], fields):
            reasons[index] = reason
        else:
            rows.append(row)
            indices.append(index)
            numbers.append(data)
        data += 1
    return _Lines(
        data, rows, np.array(indices, np.int64), np.array(numbers, np.int64), reasons, account
    )


def _cut(text: bytes, delimiter: bytes | None) -> bytes:
    if delimiter is None:
        return _BETWEEN.join(text.split())
    return text.replace(delimiter, _BETWEEN)


def _length(row: bytes) -> int:
    return row.count(_BETWEEN) + 1


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
    texts = _texts(lines.rows, columns.all, fields)
    held = [_held(triad, texts, len(lines.rows)) for triad in columns.triads]
    selected = _selected(columns, held)
    wanted = [(column, selected) for column in columns.of_every_row]
    for triad, holds in zip(columns.triads, held, strict=True):
        wanted += [(column, holds) for column in triad.columns if column]
    numbers = {column: _numbers(texts[column.index]) for column, _ in wanted}

    whole = np.ones(len(lines.rows), bool)
    reasons = dict(lines.reasons)
    for column, needed in wanted:
        for row in np.flatnonzero(whole & needed & ~np.isfinite(numbers[column])).tolist():
            value = quoted(texts[column.index][row].as_py().encode())
            reasons[int(lines.indices[row])] = (
                f"column {column.name} is '{value}', expected a finite number"
            )
            whole[row] = False
    taken = whole & selected

    def of(column: Column | None) -> Reals | None:
        return None if column is None else numbers[column][taken]

    record = records + lines.numbers[taken]
    indices = lines.indices[taken]
    accelerometer, gyro = (
        _axes(triad, numbers, holds)[taken]
        for triad, holds in zip(columns.triads, held, strict=True)
    )
    rows = Rows(
        record=record,
        offset=piece.offsets[indices],
        line=piece.lines[indices],
        ticks=record.astype(np.float64) if columns.counts_rows else of(columns.time),
        mean_of=of(columns.mean_of),
        accelerometer=accelerometer,
        gyro=gyro,
        table_angle=of(columns.table_angle),
        temperature=of(columns.temperature),
        label=_label(columns.label, texts, taken),
    )
    account = lines.account
    account.add_all(DECODED, "", piece.lengths[indices])
    account.add_all(NOT_SELECTED, "", piece.lengths[lines.indices[whole & ~selected]])
    lost = sorted(reasons)
    account.add_all(REFUSED, "", piece.lengths[lost])
    return Reading(rows, [refused_line(piece, index, reasons[index]) for index in lost], account)


def _texts(rows: list[bytes], columns: Sequence[Column], fields: int) -> dict[int, pa.ChunkedArray]:
    """The texts of the columns by index, blanks around them left out, (n,) each."""
    indices = sorted({column.index for column in columns})
    if not rows or not indices:
        return {index: pa.chunked_array([], pa.string()) for index in indices}
    table = csv.read_csv(
        pa.BufferReader(b"\n".join(rows)),
        csv.ReadOptions(
            column_names=[str(index) for index in range(fields)], block_size=2 * LONGEST_LINE
        ),
        csv.ParseOptions(
            delimiter=_BETWEEN.decode(),
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
    return {index: pc.utf8_trim_whitespace(table[str(index)]) for index in indices}


def _held(triad: Triad, texts: Mapping[int, pa.ChunkedArray], rows: int) -> Truths:
    """Which rows hold the triad, (n,)."""
    holds = np.ones(rows, bool)
    for column, value in triad.rows:
        holds &= np.array([text == value for text in texts[column.index].to_pylist()], bool)
    return holds


def _selected(columns: ColumnLayout, held: Sequence[Truths]) -> Truths:
    """Which rows hold anything: all of them, unless every triad has rows of its own, (n,)."""
    recorded = [
        holds for triad, holds in zip(columns.triads, held, strict=True) if any(triad.columns)
    ]
    return np.logical_or.reduce(recorded) if recorded else held[0]


def _numbers(texts: pa.ChunkedArray) -> Reals:
    """The numbers that the texts are, NaN where one is none, (n,)."""
    try:
        return numbers_of(pc.cast(texts, pa.float64()))
    except pa.ArrowInvalid:  # some are none: one by one
        return np.array(
            [float(text) if _NUMBER.fullmatch(text) else np.nan for text in texts.to_pylist()]
        )


def _axes(triad: Triad, numbers: Mapping[Column, Reals], holds: Truths) -> Reals:
    """The three axes of a triad; NaN where it is not recorded, (n, 3)."""
    axes = np.full((len(holds), 3), np.nan)
    for axis, column in enumerate(triad.columns):
        if column is not None:
            recorded = holds & (numbers[column] != triad.missing)
            axes[recorded, axis] = numbers[column][recorded]
    return axes


def _label(
    columns: Sequence[Column], texts: Mapping[int, pa.ChunkedArray], taken: Truths
) -> list[str] | None:
    """The text "column=value" of each column, joined with "; ", (n,)."""
    if not columns:
        return None
    parts = [
        [f"{column.name}={text}" for text in texts[column.index].to_pylist()] for column in columns
    ]
    labels = ["; ".join(each) for each in zip(*parts, strict=True)]
    return [labels[row] for row in np.flatnonzero(taken).tolist()]
