"""Which column of a log holds what: the campaign's layout, applied to the names in the file.

The layout is the JSON of the campaign's format (kind `columns`). Columns go by name, as the last
header line of a text or the container gives them, or by number from 1.
"""

import csv
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from inertial.tables.errors import Refusal
from inertial.text.messages import _

ISO_8601 = "iso8601"  # dates with the time of the day, which are read as nanoseconds
EXACT = ("ns", ISO_8601)  # stamps that a floating-point number does not hold to the last digit
_TICKS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9, ISO_8601: 1e9}  # in a second
NANOSECONDS = {"s": 10**9, "ms": 10**6, "us": 10**3, "ns": 1}  # in one of a unit
_NAMES_SHOWN = 60  # of a container, that may have thousands


@dataclass(frozen=True)
class Column:
    """A column of the file."""

    name: str  # as the layout calls it
    index: int  # from 0


@dataclass(frozen=True)
class Triad:
    """Where the three axes of a sensor are; not recorded where a column is None."""

    columns: tuple[Column | None, ...] = (None, None, None)  # x, y, z
    rows: tuple[tuple[Column, str], ...] = ()  # only rows with these texts hold the triad
    missing: float | None = None  # this value means: not recorded
    sigmas: tuple[Column | None, ...] = (None, None, None)  # of means: their standard deviations


@dataclass(frozen=True)
class ColumnLayout:
    """The columns of the file that are required."""

    accelerometer: Triad
    gyro: Triad
    counts_rows: bool  # no column holds the time: the number of the row is the time
    time: Column | None
    mean_of: Column | None
    table_angle: Column | None
    temperature: Column | None
    label: tuple[Column, ...]  # the plan selects rows by their texts
    by_name: bool  # some column goes by name, so the header has their number
    time_unit: str = "s"
    decimal: str = "."  # between the digits of a number in a text
    fraction: Column | None = None  # the rest of the time, where two columns hold it
    fraction_unit: str = "ns"

    @property
    def triads(self) -> tuple[Triad, Triad]:
        """Accelerometer, gyro."""
        return self.accelerometer, self.gyro

    @property
    def of_every_row(self) -> list[Column]:
        """The columns that hold a number in every row; a temperature may be unknown."""
        columns = (self.time, self.fraction, self.mean_of, self.table_angle)
        return [column for column in columns if column]

    @property
    def exact_time(self) -> tuple[Column, ...]:
        """The time, where a floating-point number would not hold all its digits."""
        if self.time is None:
            return ()
        if self.fraction is not None:
            return self.time, self.fraction
        return (self.time,) if self.time_unit in EXACT else ()

    @property
    def texts(self) -> list[Column]:
        """The columns whose text is required."""
        rows = [column for triad in self.triads for column, _ in triad.rows]
        return [*self.label, *rows, *self.exact_time]

    @property
    def number_indices(self) -> list[int]:
        """The columns of numbers whose text is not required."""
        numbers = {column.index for column in self.of_numbers}
        return sorted(numbers - set(self.text_indices))

    @property
    def of_numbers(self) -> list[Column]:
        """The columns of numbers."""
        temperature = [self.temperature] if self.temperature else []
        return [*self.of_every_row, *temperature, *self.axes, *self.sigmas]

    @property
    def text_indices(self) -> list[int]:
        """The columns whose text is required."""
        return sorted({column.index for column in self.texts})

    @property
    def axes(self) -> list[Column]:
        """The columns of both triads."""
        return [column for triad in self.triads for column in triad.columns if column]

    @property
    def sigmas(self) -> list[Column]:
        """The columns with the standard deviations of means, of both triads."""
        return [column for triad in self.triads for column in triad.sigmas if column]

    @property
    def all(self) -> list[Column]:
        """Every column that is required."""
        return [*self.of_numbers, *self.texts]


def without_comment_mark(header: str) -> str:
    """A line of a header, or its first name, without what marks it as a comment."""
    return header.strip().lstrip("#%/").lstrip()


def names_in_header(line: str, delimiter: str | None) -> list[str]:
    """The names of the columns in a line that separates them as the data, quoted or not (RFC 4180).

    Without what marks it as a comment, and without what a serial port held before the first line.
    """
    text = without_comment_mark(line.replace("\0", "").replace("\r", " "))
    if not text:
        return []
    fields = text.split() if delimiter is None else next(csv.reader([text], delimiter=delimiter))
    names = [name.strip().strip('"').strip() for name in fields]
    return names[:-1] if len(names) > 1 and not names[-1] else names


def has_stamps(time: Mapping[str, Any] | None) -> bool:
    """Whether the time of a layout is in a column, or in two, and not the number of the row."""
    return time is not None and (time.get("column") is not None or "columns" in time)


def ticks_per_second(layout: Mapping[str, Any]) -> float:
    """How many ticks of the log's time make a second; a tick is a sample where it counts these."""
    time = layout["time"]
    if "columns" in time:
        return _TICKS["ns"]
    if time.get("column") is None or time["unit"] == "sample":
        return float(time["rate_hz"])
    if time["unit"] == "tick":
        return float(time["ticks_per_s"])
    return _TICKS[time["unit"]]


def column_layout(
    layout: Mapping[str, Any],
    names: Sequence[str],
    file: str,
    *,
    container: bool = False,
    most: float = math.inf,
) -> ColumnLayout:
    """The layout applied to a file that gives its columns these names.

    A `container` names every column that it has; the header of a text may name none. `most`: how
    many columns the rows of a text have.

    Raises
    ------
    Refusal
        where the layout names a column that the file has not, or has twice
    """
    finder = _Finder(names, file, container, len(names) if container else most)
    time = layout.get("time")
    of_time = finder.time(time)
    units = (time or {}).get("units") or [(time or {}).get("unit", "s"), "ns"]
    return ColumnLayout(
        accelerometer=finder.triad("accelerometer", layout.get("accelerometer")),
        gyro=finder.triad("gyro", layout.get("gyro")),
        counts_rows=time is not None and not has_stamps(time),
        time=of_time[0],
        mean_of=finder.column("mean_of", layout.get("mean_of")),
        table_angle=finder.column_of("table_angle", layout.get("table_angle")),
        temperature=finder.column_of("temperature", layout.get("temperature")),
        label=tuple(finder.known("label", name) for name in layout.get("label") or ()),
        by_name=finder.by_name,
        time_unit=units[0],
        decimal=layout.get("decimal", "."),
        fraction=of_time[1],
        fraction_unit=units[1],
    )


class _Finder:
    """Finds the columns that the keys of the layout name."""

    def __init__(self, names: Sequence[str], file: str, container: bool, most: float) -> None:
        self._names, self._most = names, most
        self._file = file
        self._container = container
        self.by_name = False

    def triad(self, key: str, stated: Mapping[str, Any] | None) -> Triad:
        if stated is None:
            return Triad()
        return Triad(
            tuple(self.column(f"{key}.columns", name) for name in stated["columns"]),
            tuple(
                (self.known(f"{key}.rows", name), str(value).strip())
                for name, value in (stated.get("rows") or {}).items()
            ),
            stated.get("missing"),
            tuple(
                self.column(f"{key}.sigma_columns", name)
                for name in stated.get("sigma_columns", [None] * 3)
            ),
        )

    def time(self, stated: Mapping[str, Any] | None) -> tuple[Column | None, Column | None]:
        """The column of the time, and that of its fraction, where it is one of its own."""
        if stated is None or "columns" not in stated:
            return self.column_of("time", stated), None
        first, second = (self.known("time.columns", name) for name in stated["columns"])
        return first, second

    def column_of(self, key: str, stated: Mapping[str, Any] | None) -> Column | None:
        return None if stated is None else self.column(f"{key}.column", stated.get("column"))

    def column(self, key: str, name: str | int | None) -> Column | None:
        return None if name is None else self.known(key, name)

    def known(self, key: str, name: str | int) -> Column:
        if isinstance(name, str) and name not in self._names:
            name = without_comment_mark(name)
        if isinstance(name, str) and (times := Counter(self._names)[name]):
            if times > 1:
                holder = "file" if self._container else "header"
                raise self._refusal(
                    key,
                    _(
                        "the {holder} has {times} columns '{name}'",
                        holder=holder,
                        times=times,
                        name=name,
                    ),
                    "one",
                )
            self.by_name = True
            return Column(name, self._names.index(name))
        # A key of a JSON object is always text, so a number may come as text too.
        if str(name).isdecimal() and 1 <= int(name) <= self._most:
            return Column(str(name), int(name) - 1)
        if not all(map(str.isprintable, self._names)):
            raise Refusal(
                self._file,
                key,
                _("no column '{name}': where the names should stand is no text", name=name),
                _("text, or a container whose type is known"),
                _("export the log as text, and name that; or correct the kind of its format"),
            )
        shown = list(self._names[:_NAMES_SHOWN])
        if len(self._names) > len(shown):
            shown.append(_("and {names} more", names=len(self._names) - len(shown)))
        there = _("one of {shown}", shown=", ".join(shown)) if shown else "a number, from 1"
        raise self._refusal(key, _("no column '{name}'", name=name), there)

    def _refusal(self, key: str, found: str, expected: str) -> Refusal:
        cure = (
            _("name the column as the file does, or by its number from 1")
            if self._container
            else _(
                "name the column as the last header line does, or by its number from 1; "
                "header_lines tells how many lines come before the data"
            )
        )
        return Refusal(self._file, key, found, expected, cure)
