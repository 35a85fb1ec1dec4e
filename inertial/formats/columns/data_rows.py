"""The data rows of a log of columns, in text or not: their samples, and why one is refused."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.formats.account import Account, RefusedLine, quoted
from inertial.formats.columns.column_layout import (
    ISO_8601,
    NANOSECONDS,
    Column,
    ColumnLayout,
    Triad,
)
from inertial.formats.columns.column_values import ColumnValues
from inertial.text.messages import _


@dataclass(frozen=True)
class Rows:
    """The contents of n data rows; NaN where a value is not recorded, None where none ever is."""

    record: Integers  # number among the data rows of the log, refused ones counted, (n,)
    offset: Integers  # byte in the file where the line begins; 0 where rows are no lines, (n,)
    line: Integers  # number of the line, or of the row where rows are no lines, from 1, (n,)
    ticks: Array | Integers | None  # time; unit by `ticks_per_second` of the layout, (n,)
    mean_of: Array | None  # number of samples that the row is the mean of, (n,)
    accelerometer: Array  # x, y, z, as they stand in the file, (n, 3)
    gyro: Array  # likewise
    table_angle: Array | None  # as it stands in the file, (n,)
    temperature: Array | None  # likewise
    label: list[str] | None  # "column=value; …" of the columns that the plan selects by, (n,)
    # Of rows that are means: their standard deviations, as they stand in the file, (n, 3).
    accelerometer_sigma: Array | None = None
    gyro_sigma: Array | None = None


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
    taken: Booleans  # which rows these are, (n,)
    not_selected: Booleans  # rows that hold none of the sensors, (n,)
    reasons: dict[int, str]  # why the others are refused, by their place among the n


def sort_rows(
    columns: ColumnLayout,
    fields: Mapping[int, ColumnValues],
    place: Place,
    unreadable: Mapping[int, str] | None = None,
) -> SortedRows:
    """The rows whose wanted columns, by index, are `fields`; `unreadable` ones are refused anyway.

    A row is refused where the layout wants a number and there is no finite one. A sensor all of
    whose columns are blank in a row is not recorded in it, and a temperature that is blank or NaN
    is unknown.
    """
    count = len(place.record)
    reasons = dict(unreadable or {})
    intact = np.ones(count, bool)
    intact[list(reasons)] = False
    exact = columns.exact_time
    numbers = {
        each: fields[each.index].numbers() for each in columns.of_numbers if each not in exact
    }
    held = [_held(triad, fields, numbers, count) for triad in columns.triads]
    selected = _selected(columns, held)
    wanted = [(column, selected) for column in columns.of_every_row if column not in exact]
    axes = [_axes(*each, numbers) for each in zip(columns.triads, held, strict=True)]
    of_triads = zip(columns.triads, held, strict=True)
    wanted += [(column, holds) for triad, holds in of_triads for column in triad.columns if column]

    def refuse(column: Column, where: Booleans, expected: str) -> None:
        for row in np.flatnonzero(intact & where).tolist():
            reasons[row] = _(
                "column {name} is '{value}', expected {expected}",
                name=column.name,
                value=quoted(fields[column.index].text(row).encode()),
                expected=expected,
            )
            intact[row] = False

    stamps = np.zeros(count, np.int64)
    for column, own, known, expected in _exact_parts(columns, fields):
        refuse(column, selected & ~known, expected)
        stamps += own
    for column, needed in wanted:
        refuse(column, needed & ~np.isfinite(numbers[column]), _("a finite number"))
    if warm := columns.temperature:
        wrong = selected & _wrong(fields[warm.index], numbers[warm])
        refuse(warm, wrong, _("a finite number, or nothing where it is unknown"))
    for column, unusable in _unusable_sigmas(columns, numbers, axes):
        refuse(column, unusable, _("the standard deviation of a mean, above 0"))
    taken = intact & selected

    def ticks() -> Array | Integers | None:
        if columns.counts_rows:
            return record.astype(np.float64)
        return stamps[taken] if exact else of(columns.time)

    def of(column: Column | None) -> Array | None:
        return None if column is None else numbers[column][taken]

    record = place.record[taken]
    accelerometer, gyro = (own[taken] for own in axes)
    rows = Rows(
        record=record,
        offset=place.offset[taken],
        line=place.line[taken],
        ticks=ticks(),
        mean_of=of(columns.mean_of),
        accelerometer=accelerometer,
        gyro=gyro,
        table_angle=of(columns.table_angle),
        temperature=of(columns.temperature),
        label=_label(columns.label, fields, taken),
        accelerometer_sigma=_sigmas(columns.accelerometer, numbers, taken),
        gyro_sigma=_sigmas(columns.gyro, numbers, taken),
    )
    return SortedRows(rows, taken, intact & ~selected, reasons)


def _exact_parts(
    columns: ColumnLayout, fields: Mapping[int, ColumnValues]
) -> Iterator[tuple[Column, Integers, Booleans, str]]:
    """Each column of a time that is exact: ns, which are known, (n,) each, and what is expected."""
    time, fraction = columns.time, columns.fraction
    if time is not None and fraction is not None:
        size, part = (NANOSECONDS[unit] for unit in (columns.time_unit, columns.fraction_unit))
        most = (1 << 62) // size
        for column, unit, limits in (
            (time, size, (-most, most)),
            (fraction, part, (0, size // part)),
        ):
            own, known = _whole_numbers(fields[column.index], *limits)
            whole = _("a whole number from {least} to {most}", least=limits[0], most=limits[1])
            yield column, unit * own, known, whole
        return
    for column in columns.exact_time:
        iso = columns.time_unit == ISO_8601
        stamps, known = fields[column.index].nanoseconds(iso=iso)
        expected = _("a time such as 2026-11-02T09:30:00.005Z") if iso else _("nanoseconds")
        yield column, stamps, known, expected


def _whole_numbers(values: ColumnValues, least: int, most: int) -> tuple[Integers, Booleans]:
    """The whole numbers of a column, to the last digit, 0 where there is none; and where one is."""
    found, known = values.nanoseconds(iso=False)
    numbers = values.numbers()
    known = known & np.isfinite(numbers) & (found >= least) & (found <= most)
    known &= np.where(known, numbers, 0.0) % 1 == 0
    return np.where(known, found, 0), known


def _held(
    triad: Triad,
    fields: Mapping[int, ColumnValues],
    numbers: Mapping[Column, Array],
    count: int,
) -> Booleans:
    """Which rows hold the triad, (n,)."""
    there = [column for column in triad.columns if column]
    holds = np.ones(count, bool)
    if there and all(np.isnan(numbers[column]).any() for column in there):
        holds = ~np.logical_and.reduce([fields[column.index].blank() for column in there])
    for column, value in triad.rows:
        holds &= np.array([text == value for text in fields[column.index].texts()], bool)
    return holds


def _selected(columns: ColumnLayout, held: Sequence[Booleans]) -> Booleans:
    """Which rows hold anything: all of them, unless every triad has rows of its own, (n,)."""
    recorded = [
        holds for triad, holds in zip(columns.triads, held, strict=True) if any(triad.columns)
    ]
    return np.logical_or.reduce(recorded) if recorded else held[0]


def _sigmas(triad: Triad, numbers: Mapping[Column, Array], taken: Booleans) -> Array | None:
    """The standard deviations of means, (m, 3), NaN where none is stated; None without any."""
    if not any(triad.sigmas):
        return None
    none = np.full(len(taken), np.nan)
    own = [none if column is None else numbers[column] for column in triad.sigmas]
    return np.column_stack(own)[taken]


def _wrong(values: ColumnValues, numbers: Array) -> Booleans:
    """Where there is neither a number nor nothing, (n,)."""
    infinite = ~np.isfinite(numbers)
    return infinite & ~values.unknown() if infinite.any() else infinite


def _unusable_sigmas(
    columns: ColumnLayout, numbers: Mapping[Column, Array], axes: Sequence[Array]
) -> Iterator[tuple[Column, Booleans]]:
    """The columns of standard deviations, and in which rows a mean has none."""
    for triad, means in zip(columns.triads, axes, strict=True):
        for column, mean in zip(triad.sigmas, means.T, strict=True):
            if column is not None:
                known = np.isfinite(numbers[column]) & (numbers[column] > 0)
                yield column, np.isfinite(mean) & ~known


def _axes(triad: Triad, holds: Booleans, numbers: Mapping[Column, Array]) -> Array:
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
    columns: Sequence[Column], fields: Mapping[int, ColumnValues], taken: Booleans
) -> list[str] | None:
    """The text "column=value" of each column, joined with "; ", (n,)."""
    if not columns:
        return None
    parts = [
        [f"{column.name}={text}" for text in fields[column.index].texts()] for column in columns
    ]
    labels = ["; ".join(row) for row in zip(*parts, strict=True)]
    return [labels[row] for row in np.flatnonzero(taken).tolist()]
