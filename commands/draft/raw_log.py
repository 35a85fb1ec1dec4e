"""The columns of a log as the project's own readers have them, whatever they are."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from commands.draft.text_layout import TextLayout, text_layout
from inertial.formats.columns import column_reader, vectornav_lines
from inertial.formats.file_type import FileType, file_type_of
from inertial.formats.gps_time import NANOSECONDS
from inertial.formats.novatel import novatel_reader
from inertial.tables.errors import Refusal
from inertial.text.messages import _

Array = NDArray[np.float64]
Name = str | int
MAX_WORDS = 50  # different ones in a column that labels rows
SENSORS = ("accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z")
SENT = (2, 1, 0, 5, 4, 3)  # a receiver sends z, −y, x
SENT_SIGNS = (1, -1, 1, 1, -1, 1)


@dataclass(frozen=True)
class RawLog:
    """A log: `columns` and `words` by the name, or number from 1, of the campaign file.

    `layout`: what the format of the campaign file states beside the columns; `header`: the lines
    before the data; `columns`: (n,) numbers each, NaN where there is none; `words`: n texts each,
    of a few different ones; `dates`: columns of dates, in s.
    """

    path: Path
    layout: Mapping[str, Any]
    columns: Mapping[Name, Array]
    header: Sequence[str] = ()
    words: Mapping[Name, Sequence[str]] = field(default_factory=dict)
    dates: Sequence[Name] = ()

    @property
    def kind(self) -> str:
        """The kind of its format."""
        return str(self.layout["kind"])

    @property
    def rows(self) -> int:
        """How many data rows."""
        return max((len(values) for values in self.columns.values()), default=0)


def raw_log(path: Path) -> RawLog:
    """The log at `path`.

    Raises
    ------
    Refusal
        where no columns of numbers are in it
    """
    names = column_reader.names_in(path)
    if names is not None:
        layout: dict[str, Any] = {"kind": "columns"}
        columns: dict[Name, Array] = {}
        for matrix in _matrices(names):
            columns |= _numbers(path, layout, matrix)
        return RawLog(path, layout, columns)
    if file_type_of(path) is FileType.TEXT and (messages := _receiver_log(path)) is not None:
        return messages
    with path.open("rb") as file:
        if file.read(3) == b"$VN":
            return _vectornav_log(path)
    found = text_layout(path)
    if found is None:
        raise Refusal(
            path.name,
            "",
            _("no rows of numbers"),
            _("the samples of an IMU: messages of a receiver, or rows of columns"),
            _("name the log itself; another format has to be exported as text first"),
        )
    return _text_log(path, found)


def _text_log(path: Path, found: TextLayout) -> RawLog:
    def column(place: int) -> Name:
        return found.names[place] if found.names else place + 1

    layout = {"kind": "columns", **found.stated}
    columns = _numbers(path, layout, [column(place) for place in found.numbers])
    dates = [column(place) for place in found.dates]
    for name in dates:
        columns[name] = _dates(path, layout, name)
    labels = {}
    for place in found.words:
        words = _words(path, layout, column(place))
        if len(set(words)) <= MAX_WORDS:
            labels[column(place)] = words
    return RawLog(path, layout, columns, found.header, labels, dates)


def _receiver_log(path: Path) -> RawLog | None:
    """The increments of a receiver's log, in counts along body axes; None where it has none."""
    stamps: list[Array] = []
    counts: list[NDArray[np.int32]] = []
    for reading in novatel_reader.read(path):
        if not stamps and not len(reading.records.stamp):
            return None  # text as long as a chunk without a message
        stamps.append(reading.records.stamp / NANOSECONDS)
        counts.append(reading.records.counts)
    if not stamps:
        return None
    body = np.concatenate(counts)[:, SENT] * np.array(SENT_SIGNS)
    columns: dict[Name, Array] = {"time": np.concatenate(stamps)}
    columns |= {name: body[:, i].astype(np.float64) for i, name in enumerate(SENSORS)}
    return RawLog(path, {"kind": "rawimus"}, columns)


def _vectornav_log(path: Path) -> RawLog:
    """The readings of a VectorNav sensor, whose columns are known."""
    layout = vectornav_lines.layout_of({})
    values = _numbers(path, layout, [5, 6, 7, 8, 9, 10])
    units = ["m/s2"] * 3 + ["rad/s"] * 3
    columns: dict[Name, Array] = {
        f"{name} [{unit}]": own
        for name, unit, own in zip(SENSORS, units, values.values(), strict=True)
    }
    return RawLog(path, {"kind": "vectornav"}, columns)


def _matrices(names: Sequence[str]) -> Iterator[list[str]]:
    """The columns of a container, those of each matrix together."""
    by_matrix: dict[str, list[str]] = {}
    for name in names:
        stem, _point, place = name.rpartition(".")
        by_matrix.setdefault(stem if place.isdecimal() else name, []).append(name)
    yield from by_matrix.values()


def _numbers(path: Path, layout: Mapping[str, Any], columns: Sequence[Name]) -> dict[Name, Array]:
    """The numbers of these columns; the reader takes three at a time, as axes of a sensor."""
    values: dict[Name, Array] = {}
    for first in range(0, len(columns), 3):
        three = columns[first : first + 3]
        padded = [*three, *[None] * (3 - len(three))]
        wanted = {**layout, "accelerometer": {"columns": padded, "unit": "m/s2"}}
        wanted.pop("gyro", None)
        records, numbers = [], []
        for reading in column_reader.read(path, wanted):
            records.append(reading.records.record)
            numbers.append(reading.records.accelerometer)
        place = np.concatenate(records) if records else np.zeros(0, np.int64)
        whole = np.full((int(place.max(initial=-1)) + 1, 3), np.nan)
        whole[place] = np.concatenate(numbers) if numbers else np.empty((0, 3))
        values |= {name: whole[:, axis] for axis, name in enumerate(three)}
    return values


def _dates(path: Path, layout: Mapping[str, Any], column: Name) -> Array:
    """A column of dates as seconds since 1970."""
    ticks = []
    for reading in column_reader.read(
        path, {**layout, "time": {"column": column, "unit": "iso8601"}}
    ):
        if reading.records.ticks is not None:
            ticks.append(reading.records.ticks / NANOSECONDS)
    return np.concatenate(ticks) if ticks else np.zeros(0)


def _words(path: Path, layout: Mapping[str, Any], column: Name) -> list[str]:
    """The texts of one column, row by row."""
    words: list[str] = []
    for reading in column_reader.read(path, {**layout, "label": [column]}):
        words += [label.partition("=")[2] for label in reading.records.label or []]
    return words
