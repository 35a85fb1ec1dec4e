"""A log that is no text: a table whose columns a library hands over, some rows at a time.

Its rows are no lines. `line` is the number of the row from 1, `offset` is 0 and a refused row has 0
bytes, for no byte of such a file can be pointed at as a row. The account gives the size of the
whole file to the rows that were decoded, or to `header` where there are none.

A row is refused that has no finite number where the layout wants one. Words are no numbers, though
they may look so. Where the plan selects rows by the text of a number, a whole number has no point.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from inertial.tables.errors import Refusal
from stages.formats.account import (
    DECODED,
    HEADER,
    NOT_SELECTED,
    REFUSED,
    Account,
    RefusedLine,
)
from stages.formats.column_layout import ColumnLayout, column_layout
from stages.formats.fields import Field
from stages.formats.rows import Place, Reading, sort_rows

PORTION_ROWS = 1 << 16  # rows that are handed over at once

T = TypeVar("T")


@dataclass(frozen=True)
class Portion:
    """Some consecutive rows of a table."""

    count: int  # how many they are, n
    fields: Mapping[int, Field]  # the wanted columns by index, n values each
    lost: Mapping[int, str] = field(default_factory=dict)  # rows beyond reading, by place: why
    account: Account = field(default_factory=Account)  # of what is no row


@dataclass(frozen=True)
class Table:
    """A container that is open."""

    names: Sequence[str]  # of its columns
    portions: Callable[[Sequence[int]], Iterator[Portion]]  # its rows, given the columns wanted


Opening = Callable[[Path, Mapping[str, Any]], AbstractContextManager[Table]]


def read(path: Path, layout: Mapping[str, Any], opening: Opening) -> Iterator[Reading]:
    """The log at `path` in this layout, `opening` being how such a container is opened.

    Raises
    ------
    Refusal
        where the layout names a column that is not there, and where the file is damaged
    """
    rest = path.stat().st_size  # bytes that are in no account yet
    records = 0
    with ExitStack() as stack:
        table = _told(path, lambda: stack.enter_context(opening(path, layout)))
        columns = column_layout(layout, table.names, path.name, container=True)
        portions = table.portions(sorted({column.index for column in columns.all}))
        while (portion := _told(path, lambda: next(portions, None))) is not None:
            reading = _reading(portion, columns, records)
            records += portion.count
            if len(reading.records.record):
                reading.account.add(DECODED, "", 0, rest)
                rest = 0
            yield reading
    if rest:
        nothing = Portion(0, {column.index: _Nothing() for column in columns.all})
        reading = _reading(nothing, columns, records)
        reading.account.add(HEADER, "", 0, rest)
        yield reading


def _reading(portion: Portion, columns: ColumnLayout, records: int) -> Reading:
    """The rows of `portion`, `records` rows being before it."""
    record = np.arange(records, records + portion.count, dtype=np.int64)
    place = Place(record, np.zeros(portion.count, np.int64), record + 1)
    found = sort_rows(columns, portion.fields, place, portion.lost)
    refused = [
        RefusedLine(line=records + row + 1, offset=0, bytes=0, reason=reason, text="")
        for row, reason in sorted(found.reasons.items())
    ]
    account = portion.account
    for kind, rows in (
        (DECODED, int(found.taken.sum())),
        (NOT_SELECTED, int(found.not_selected.sum())),
        (REFUSED, len(refused)),
    ):
        if rows:
            account.add(kind, "", rows, 0)
    return Reading(found.rows, refused, account)


class _Nothing:
    """A column without rows."""

    def numbers(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        return np.zeros(0)

    def texts(self) -> list[str]:
        return []

    def text(self, row: int) -> str:
        raise IndexError(row)


def _told(path: Path, ask: Callable[[], T]) -> T:
    """What the library answers; what it says of a damaged file becomes a refusal."""
    try:
        return ask()
    except Refusal:
        raise
    except Exception as error:  # each library has its own, and damage finds the odd ones
        said = " ".join(str(error).split())[:300] or type(error).__name__
        raise Refusal(
            path.name,
            "",
            f"a file that cannot be read: {said}",
            "a whole file",
            "copy the log anew from where it was recorded; this one is cut off or damaged",
        ) from error
