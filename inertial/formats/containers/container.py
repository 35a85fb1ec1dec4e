"""Logs in containers: their columns as rows, read under a limit of memory."""

import resource
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

import numpy as np

from inertial.formats.account import (
    DECODED,
    HEADER,
    NOT_SELECTED,
    REFUSED,
    Account,
    RefusedLine,
)
from inertial.formats.columns.column_layout import ColumnLayout, column_layout
from inertial.formats.columns.column_values import ColumnValues, NumberValues
from inertial.formats.columns.data_rows import Place, Reading, sort_rows
from inertial.tables.errors import Refusal
from inertial.text.messages import _

# ---- A limit on the memory that a library may take while it reads a container.
#
# A few bytes of a compressed file can unpack to more than any memory holds. The limit is one of
# the kernel on the address space of the process (RLIMIT_AS): what a library allocates beyond it
# fails there and then. It counts from the address space in use, of which pyarrow and numba
# reserve much.

MAX_READER_BYTES = 4 << 30

_STATM = Path("/proc/self/statm")  # its first number: pages of address space
_LOCK = Lock()  # the limit is the whole process's


@contextmanager
def limited_memory() -> Iterator[None]:
    """Limit the memory that is allocated inside; without effect where there is no /proc."""
    if not _STATM.exists():
        yield
        return
    with _LOCK:
        used = int(_STATM.read_text().split()[0]) * resource.getpagesize()
        soft, hard = resource.getrlimit(resource.RLIMIT_AS)
        set_limits = [limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY]
        limit = min([used + MAX_READER_BYTES, *set_limits])
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


# ---- Reader of a container: a table whose columns a library returns, some rows at a time.
#
# Its rows are not lines. `line` is the number of the row from 1, `offset` is 0 and a refused row
# has 0 bytes, because a row has no place in such a file. The account assigns the size of the
# whole file to the rows that were decoded, or to `header` where there are none.
#
# A row is refused that has no finite number where the layout requires one. Words are never
# numbers. Where the plan selects rows by the text of a number, a whole number has no point.

BATCH_ROWS = 1 << 16  # rows that are returned at once
MAX_ROWS_PER_BYTE = 1032  # the largest ratio of deflate; a row has a byte at least

T = TypeVar("T")


@dataclass(frozen=True)
class Batch:
    """Some consecutive rows of a table."""

    count: int  # number of rows, n
    columns: Mapping[int, ColumnValues]  # the required columns by index, n values each
    unreadable: Mapping[int, str] = field(default_factory=dict)  # reasons by row of the batch
    account: Account = field(default_factory=Account)  # of what is not a row


@dataclass(frozen=True)
class Table:
    """An open container."""

    names: Sequence[str]  # of its columns
    batches: Callable[[Sequence[int]], Iterator[Batch]]  # its rows, given the required columns


Opening = Callable[[Path, Mapping[str, Any]], AbstractContextManager[Table]]


def read(path: Path, layout: Mapping[str, Any], opened: Opening) -> Iterator[Reading]:
    """The log at `path` in this layout; `opened` opens such a container.

    Raises
    ------
    Refusal
        where the layout names a column that is missing; where the file is damaged or needs too
        much memory
    """
    rest = path.stat().st_size  # bytes not in the account yet
    records = 0
    with ExitStack() as stack:
        table = _guarded(path, lambda: stack.enter_context(opened(path, layout)))
        columns = column_layout(layout, table.names, path.name, container=True)
        batches = table.batches(sorted({column.index for column in columns.all}))
        while (batch := _guarded(path, lambda: next(batches, None))) is not None:
            reading = _reading(batch, columns, records)
            records += batch.count
            if len(reading.records.record):
                reading.account.add(DECODED, "", 0, rest)
                rest = 0
            yield reading
    if rest:
        empty = NumberValues(np.zeros(0))
        reading = _reading(Batch(0, {c.index: empty for c in columns.all}), columns, records)
        reading.account.add(HEADER, "", 0, rest)
        yield reading


def names_in(path: Path, opened: Opening) -> list[str]:
    """The names of the columns of the container at `path`."""
    with ExitStack() as stack:
        return list(_guarded(path, lambda: stack.enter_context(opened(path, {}))).names)


def _reading(batch: Batch, columns: ColumnLayout, records: int) -> Reading:
    """The samples of `batch`, with `records` rows before it."""
    record = np.arange(records, records + batch.count, dtype=np.int64)
    place = Place(record, np.zeros(batch.count, np.int64), record + 1)
    rows = sort_rows(columns, batch.columns, place, batch.unreadable)
    refused = [
        RefusedLine(line=records + row + 1, offset=0, bytes=0, reason=reason, text="")
        for row, reason in sorted(rows.reasons.items())
    ]
    account = batch.account
    for kind, count in (
        (DECODED, int(rows.taken.sum())),
        (NOT_SELECTED, int(rows.not_selected.sum())),
        (REFUSED, len(refused)),
    ):
        if count:
            account.add(kind, "", count, 0)
    return Reading(rows.samples, refused, account)


def refuse_excessive_rows(path: Path, rows: int) -> None:
    """Refuse the file where it states more rows than its bytes can hold."""
    if rows > MAX_ROWS_PER_BYTE * (size := path.stat().st_size):
        raise Refusal(
            path.name,
            "",
            _("{rows} rows stated in {size} bytes", rows=rows, size=size),
            _("at most {max_rows_per_byte} rows per byte", max_rows_per_byte=MAX_ROWS_PER_BYTE),
            _("copy the log anew from where it was recorded; this file is damaged or no log"),
        )


def _guarded(path: Path, call: Callable[[], T]) -> T:
    """The library's result within the memory limit; its error becomes a refusal."""
    try:
        with limited_memory():
            return call()
    except Refusal:
        raise
    except Exception as error:  # each library has its own, and damage causes any of them
        message = " ".join(str(error).split())[:300] or type(error).__name__
        if _is_lack_of_memory(error):
            raise Refusal(
                path.name,
                "",
                _("a file that unpacks to too much at once: {value}", value=message),
                _(
                    "at most {max_reader_bytes} bytes of memory to read it",
                    max_reader_bytes=MAX_READER_BYTES,
                ),
                _(
                    "write the log anew in smaller pieces; if it never was that large, the file is "
                    "damaged"
                ),
            ) from error
        raise Refusal(
            path.name,
            "",
            _("a file that cannot be read: {value}", value=message),
            "a whole file",
            _("copy the log anew from where it was recorded; this one is cut off or damaged"),
        ) from error


def _is_lack_of_memory(error: BaseException | None) -> bool:
    """Whether the error, or one that caused it, is a failed allocation."""
    while error is not None and not isinstance(error, MemoryError):
        error = error.__cause__ or error.__context__
    return error is not None
