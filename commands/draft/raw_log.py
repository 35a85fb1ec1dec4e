"""The columns of a log as the project's own readers have them, whatever they are."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from commands.draft.text_layout import TextLayout, text_layout
from inertial.formats.columns import column_reader
from inertial.tables.errors import Refusal
from inertial.text.messages import _

Array = NDArray[np.float64]
MAX_WORDS = 50  # different ones in a column that labels rows


@dataclass(frozen=True)
class RawLog:
    """A log of columns: `columns` and `words` by the name, or number from 1, of the campaign file.

    `layout`: what the format of the campaign file states beside the columns; `header`: the lines
    before the data; `columns`: (n,) numbers each, NaN where there is none; `words`: n texts each,
    of a few different ones.
    """

    path: Path
    layout: Mapping[str, Any]
    header: Sequence[str]
    columns: Mapping[str | int, Array]
    words: Mapping[str | int, Sequence[str]] = field(default_factory=dict)

    @property
    def rows(self) -> int:
        """How many data rows."""
        return max((len(values) for values in self.columns.values()), default=0)


def raw_log(path: Path) -> RawLog:
    """The log of columns at `path`.

    Raises
    ------
    Refusal
        where no columns of numbers are in it
    """
    names = column_reader.names_in(path)
    if names is not None:
        layout: dict[str, Any] = {"kind": "columns"}
        columns: dict[str | int, Array] = {}
        for matrix in _matrices(names):
            columns |= _numbers(path, layout, matrix)
        return RawLog(path, layout, [], columns)
    found = text_layout(path)
    if found is None:
        raise Refusal(
            path.name,
            "",
            _("no rows of numbers"),
            _("the samples of an IMU: messages of a NovAtel receiver, or rows of columns"),
            _("name the log itself; another format has to be exported as text first"),
        )
    return _text_log(path, found)


def _text_log(path: Path, found: TextLayout) -> RawLog:
    def column(place: int) -> str | int:
        return found.names[place] if found.names else place + 1

    layout: dict[str, Any] = {"kind": "columns"}
    if found.delimiter is not None:
        layout["delimiter"] = found.delimiter
    if found.header:
        layout["header_lines"] = len(found.header)
    columns = _numbers(path, layout, [column(place) for place in found.numbers])
    labels = {}
    for place in found.words:
        words = _words(path, layout, column(place))
        if len(set(words)) <= MAX_WORDS:
            labels[column(place)] = words
    return RawLog(path, layout, found.header, columns, labels)


def _matrices(names: Sequence[str]) -> Iterator[list[str]]:
    """The columns of a container, those of each matrix together."""
    by_matrix: dict[str, list[str]] = {}
    for name in names:
        stem, _point, place = name.rpartition(".")
        by_matrix.setdefault(stem if place.isdecimal() else name, []).append(name)
    yield from by_matrix.values()


def _numbers(
    path: Path, layout: Mapping[str, Any], columns: Sequence[str | int]
) -> dict[str | int, Array]:
    """The numbers of these columns; the reader takes three at a time, as axes of a sensor."""
    values: dict[str | int, Array] = {}
    for first in range(0, len(columns), 3):
        three = columns[first : first + 3]
        padded = [*three, *[None] * (3 - len(three))]
        wanted = {**layout, "accelerometer": {"columns": padded, "unit": "m/s2"}}
        records, numbers = [], []
        for reading in column_reader.read(path, wanted):
            records.append(reading.records.record)
            numbers.append(reading.records.accelerometer)
        place = np.concatenate(records) if records else np.zeros(0, np.int64)
        whole = np.full((int(place.max(initial=-1)) + 1, 3), np.nan)
        whole[place] = np.concatenate(numbers) if numbers else np.empty((0, 3))
        values |= {name: whole[:, axis] for axis, name in enumerate(three)}
    return values


def _words(path: Path, layout: Mapping[str, Any], column: str | int) -> list[str]:
    """The texts of one column, row by row."""
    words: list[str] = []
    for reading in column_reader.read(path, {**layout, "label": [column]}):
        words += [label.partition("=")[2] for label in reading.records.label or []]
    return words
