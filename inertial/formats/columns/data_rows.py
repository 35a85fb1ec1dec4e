"""The data rows of a log of columns, in text or not: their samples, and why one is refused."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.formats.account import Account, Integers, RefusedLine, quoted
from inertial.formats.columns.column_layout import Column, ColumnLayout, Triad
from inertial.formats.columns.column_values import ColumnValues, Reals
from inertial.text.messages import _

Truths = NDArray[np.bool_]


@dataclass(frozen=True)
class Rows:
    """The contents of n data rows; NaN where a value is not recorded, None where none ever is."""

    record: Integers  # number among the data rows of the log, refused ones counted, (n,)
    offset: Integers  # byte in the file where the line begins; 0 where rows are no lines, (n,)
    line: Integers  # number of the line, or of the row where rows are no lines, from 1, (n,)
    ticks: Reals | None  # time; unit by `ticks_per_second` of the layout, (n,)
    mean_of: Reals | None  # number of samples that the row is the mean of, (n,)
    accelerometer: Reals  # x, y, z, as they stand in the file, (n, 3)
    gyro: Reals  # likewise
    table_angle: Reals | None  # as it stands in the file, (n,)
    temperature: Reals | None  # likewise
    label: list[str] | None  # "column=value; …" of the columns that the plan selects by, (n,)


@dataclass(frozen=True)
class Reading:
    """The contents of a chunk of the log."""

    records: Rows
    refused: list[RefusedLine]
    account: Account


@dataclass(frozen=True)
class Place:
    """Where n data rows stand in the log; as in `Rows`, (n,) each."""

    record: Integers
    offset: Integers
    line: Integers


@dataclass(frozen=True)
class SortedRows:
    """n data rows by kind."""

    samples: Rows  # the m rows that hold a sample
    taken: Truths  # which rows these are, (n,)
    not_selected: Truths  # rows that hold none of the sensors, (n,)
    reasons: dict[int, str]  # why the others are refused, by their place among the n


def sort_rows(
    columns: ColumnLayout,
    fields: Mapping[int, ColumnValues],
    place: Place,
    unreadable: Mapping[int, str] | None = None,
) -> SortedRows:
    """The rows whose wanted columns, by index, are `fields`; `unreadable` ones are refused anyway.

    A row is refused where the layout wants a number and there is no finite one.
    """
    count = len(place.record)
    reasons = dict(unreadable or {})
    intact = np.ones(count, bool)
    intact[list(reasons)] = False
    held = [_held(triad, fields, count) for triad in columns.triads]
    selected = _selected(columns, held)
    wanted = [(column, selected) for column in columns.of_every_row]
    for triad, holds in zip(columns.triads, held, strict=True):
        wanted += [(column, holds) for column in triad.columns if column]
    numbers = {column: fields[column.index].numbers() for column, _unused in wanted}

    for column, needed in wanted:
        for row in np.flatnonzero(intact & needed & ~np.isfinite(numbers[column])).tolist():
            value = quoted(fields[column.index].text(row).encode())
            reasons[row] = _(
                "column {name} is '{value}', expected a finite number",
                name=column.name,
                value=value,
            )
            intact[row] = False
    taken = intact & selected

    def of(column: Column | None) -> Reals | None:
        return None if column is None else numbers[column][taken]

    record = place.record[taken]
    accelerometer, gyro = (
        _axes(triad, numbers, holds)[taken]
        for triad, holds in zip(columns.triads, held, strict=True)
    )
    rows = Rows(
        record=record,
        offset=place.offset[taken],
        line=place.line[taken],
        ticks=record.astype(np.float64) if columns.counts_rows else of(columns.time),
        mean_of=of(columns.mean_of),
        accelerometer=accelerometer,
        gyro=gyro,
        table_angle=of(columns.table_angle),
        temperature=of(columns.temperature),
        label=_label(columns.label, fields, taken),
    )
    return SortedRows(rows, taken, intact & ~selected, reasons)


def _held(triad: Triad, fields: Mapping[int, ColumnValues], count: int) -> Truths:
    """Which rows hold the triad, (n,)."""
    holds = np.ones(count, bool)
    for column, value in triad.rows:
        holds &= np.array([text == value for text in fields[column.index].texts()], bool)
    return holds


def _selected(columns: ColumnLayout, held: Sequence[Truths]) -> Truths:
    """Which rows hold anything: all of them, unless every triad has rows of its own, (n,)."""
    recorded = [
        holds for triad, holds in zip(columns.triads, held, strict=True) if any(triad.columns)
    ]
    return np.logical_or.reduce(recorded) if recorded else held[0]


def _axes(triad: Triad, numbers: Mapping[Column, Reals], holds: Truths) -> Reals:
    """The three axes of a triad; NaN where it is not recorded, (n, 3)."""
    axes = np.full((len(holds), 3), np.nan)
    for axis, column in enumerate(triad.columns):
        if column is not None:
            recorded = holds
            if triad.missing is not None:
                recorded = holds & (numbers[column] != triad.missing)
            axes[recorded, axis] = numbers[column][recorded]
    return axes


def _label(
    columns: Sequence[Column], fields: Mapping[int, ColumnValues], taken: Truths
) -> list[str] | None:
    """The text "column=value" of each column, joined with "; ", (n,)."""
    if not columns:
        return None
    parts = [
        [f"{column.name}={text}" for text in fields[column.index].texts()] for column in columns
    ]
    labels = ["; ".join(row) for row in zip(*parts, strict=True)]
    return [labels[row] for row in np.flatnonzero(taken).tolist()]
