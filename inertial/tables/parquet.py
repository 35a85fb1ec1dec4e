"""Tables as Parquet: the only place that reads or writes it."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self, TypeAlias

import pyarrow as pa
import pyarrow.parquet as pq

from inertial.tables.errors import Refusal
from inertial.tables.table import Column, Table
from inertial.text.messages import ENGLISH, in_this_language, language, learn, needed

if TYPE_CHECKING:  # decode streams record batches and starts faster without pandas
    import pandas as pd

BATCH_ROWS = 65536  # rows that a stream holds in memory at a time
RERUN = "delete the file and run the campaign again"


TYPES: dict[str, pa.DataType] = {
    "double": pa.float64(),
    "string": pa.string(),
    "int64": pa.int64(),
    "uint32": pa.uint32(),
    "bool": pa.bool_(),
    "label": pa.dictionary(pa.int32(), pa.string()),
    "texts": pa.list_(pa.string()),
    "sentence": pa.string(),
}
WORDS = ("string", "label", "sentence")
MESSAGES = b"messages"  # what the sentences of a file were made of
MOST_SENTENCES = 1000  # of a table, whose messages are kept
# Rows of a table: as a frame, as a batch of Arrow, or one mapping for each.
Rows: TypeAlias = "pd.DataFrame | pa.RecordBatch | Sequence[Mapping[str, Any]]"


@cache
def schema_of(table: Table) -> pa.Schema:
    """The Arrow schema, with unit, frame and meaning of each column in its metadata."""
    fields = [_field(column) for column in table.columns]
    return pa.schema(fields, {"table": table.name, "version": str(table.version)})


def _field(column: Column) -> pa.Field:
    kind = column.type
    metadata = {"unit": column.unit, "frame": column.frame, "meaning": column.meaning}
    of = TYPES[kind] if isinstance(kind, str) else pa.list_(pa.struct([_field(c) for c in kind]))
    return pa.field(column.name, of, column.nullable, metadata)


def _written(table: Table) -> dict[str, Any]:
    """How Parquet writes a table: texts as dictionaries; of measured numbers there are too many."""
    texts = [column.name for column in table.columns if column.type in WORDS]
    return {"compression": "zstd", "use_dictionary": texts, "write_statistics": False}


def read(table: Table, path: Path) -> pd.DataFrame:
    """The whole table; for tables that are small."""
    with _readable(path):
        _check(table, path)
        frame: pd.DataFrame = pq.read_table(path).to_pandas()
        if any(column.type == "sentence" for column in table.columns):
            _understand(table, pq.read_metadata(path).metadata or {}, frame)
    return frame


def _understand(table: Table, metadata: Mapping[bytes, bytes], frame: pd.DataFrame) -> None:
    """The sentences of a table in the language of this process; it can write them again."""
    if MESSAGES in metadata:
        learn(json.loads(metadata[MESSAGES]))
    if language() != ENGLISH:
        for column in table.columns:
            if column.type == "sentence":
                texts = frame[column.name].dropna().unique()
                said = {text: in_this_language(text) for text in texts}
                frame[column.name] = frame[column.name].map(said)


def stream(table: Table, path: Path) -> Stream:
    """The table batch by batch, as often as wanted; for tables that may be large."""
    with _readable(path):
        _check(table, path)
    return Stream(path)


def write_once(table: Table, path: Path, rows: Rows) -> None:
    """Write a file that never changes again; where there is one already, that one stays.

    It is written beside its place and then linked there whole. The link fails where
    another process was first, so nobody waits and no lock is left after a kill.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{secrets.token_hex(4)}.part")
    try:
        with part.open("xb") as file:
            pq.write_table(arrow(table, rows), file, **_written(table))
            file.flush()
            os.fsync(file.fileno())
        with suppress(FileExistsError):
            path.hardlink_to(part)
    finally:
        part.unlink(missing_ok=True)


def arrow(table: Table, rows: Rows) -> pa.Table:
    """`rows` in the columns of the contract.

    Raises
    ------
    ValueError
        where a column is missing, or has gaps that the contract does not allow
    """
    schema = schema_of(table)
    if isinstance(rows, pa.RecordBatch):
        made = pa.Table.from_batches([rows]).select(schema.names).cast(schema)
    else:
        if not hasattr(rows, "columns"):
            rows = table.frame(rows)
        if missing := [name for name in schema.names if name not in rows]:
            raise ValueError(f"the {table.name} table lacks {', '.join(missing)}")
        made = pa.Table.from_pandas(rows[schema.names], schema=schema, preserve_index=False)
    for column in table.columns:
        if not column.nullable and made[column.name].null_count:
            raise ValueError(f"the {table.name} table has gaps in {column.name}")
    return made.replace_schema_metadata(schema.metadata)


def _check(table: Table, path: Path) -> None:
    metadata = pq.read_schema(path).metadata or {}
    written = {key.decode(): value.decode() for key, value in metadata.items()}
    found = f"{written.get('table')} table of version {written.get('version')}"
    expected = f"{table.name} table of version {table.version}"
    if found != expected:
        raise Refusal(str(path), "", found, expected, RERUN)


@dataclass(frozen=True)
class Stream:
    """A table on disk that is read batch by batch; every loop over it starts anew."""

    path: Path

    def __iter__(self) -> Iterator[pa.RecordBatch]:
        return self._batches(None)

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        """The same, of some columns only."""
        return self._batches(names)

    def rows(self, first: int, after: int, names: list[str]) -> Iterator[pa.RecordBatch]:
        """Some columns of the rows [first, after); only the row groups that hold them are read."""
        with _readable(self.path), pq.ParquetFile(self.path, pre_buffer=False) as file:
            end = 0
            for group in range(file.num_row_groups):
                start, end = end, end + file.metadata.row_group(group).num_rows
                if start < after and first < end:
                    part = file.read_row_group(group, columns=names)
                    begin = max(first - start, 0)
                    wanted = part.slice(begin, min(after, end) - start - begin)
                    yield from wanted.combine_chunks().to_batches()

    def _batches(self, names: list[str] | None) -> Iterator[pa.RecordBatch]:
        # A buffer beforehand would hold all that is read, up to the end.
        with _readable(self.path), pq.ParquetFile(self.path, pre_buffer=False) as file:
            yield from file.iter_batches(batch_size=BATCH_ROWS, columns=names)


def provenance(path: Path) -> dict[str, Any]:
    """What made the table at `path`: stage, settings, hash of its code, hashes of its inputs."""
    with _readable(path):
        metadata = pq.read_metadata(path).metadata or {}
    if b"made_by" not in metadata:
        raise Refusal(str(path), "", "no word of what made it", "a table of a stage", RERUN)
    return dict(json.loads(metadata[b"made_by"]))


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Refuse by name what is missing or damaged."""
    try:
        yield
    except FileNotFoundError:
        raise Refusal(
            str(path), "", "no such file", "a Parquet table", "run the campaign again"
        ) from None
    except (pa.ArrowException, OSError) as error:
        damage, *_ = str(error).splitlines() or [""]
        raise Refusal(str(path), "", f"damage: {damage}", "a Parquet table", RERUN) from None


class Writer:
    """The tables of one stage, written beside their place and moved there all at the end.

    A stage that fails or is killed leaves no table under a final name; the parts
    it may leave are overwritten by its next run. `made_by` is asked at the end.
    """

    def __init__(
        self, folder: Path, tables: Mapping[str, Table], made_by: Callable[[], Mapping[str, Any]]
    ) -> None:
        self._folder = folder
        self._tables = tables
        self._made_by = made_by
        self._files: dict[str, pq.ParquetWriter] = {}
        self._sentences: dict[str, set[str]] = {name: set() for name in tables}
        self._open = ExitStack()

    def __enter__(self) -> Self:
        self._folder.mkdir(parents=True, exist_ok=True)
        try:
            for name, table in self._tables.items():
                writer = pq.ParquetWriter(self._part(name), schema_of(table), **_written(table))
                self._files[name] = self._open.enter_context(writer)
        except OSError:
            self._remove_parts()
            raise
        return self

    def write(self, name: str, rows: Rows) -> None:
        """Add `rows` to the table `name`."""
        table = arrow(self._tables[name], rows)
        self._files[name].write_table(table)
        for column in self._tables[name].columns:
            if column.type == "sentence" and len(self._sentences[name]) < MOST_SENTENCES:
                self._sentences[name].update(filter(None, table[column.name].unique().to_pylist()))

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            with self._open:
                if kind is None:
                    made_by = json.dumps(self._made_by(), sort_keys=True).encode()
                    for name, file in self._files.items():
                        file.add_key_value_metadata({b"made_by": made_by})
                        if texts := sorted(self._sentences[name])[:MOST_SENTENCES]:
                            messages = json.dumps(needed(texts), ensure_ascii=False, sort_keys=True)
                            file.add_key_value_metadata({MESSAGES: messages.encode()})
            if kind is None:
                for name in self._tables:
                    self._part(name).replace(self._folder / f"{name}.parquet")
        finally:
            self._remove_parts()

    def _remove_parts(self) -> None:
        for name in self._tables:
            self._part(name).unlink(missing_ok=True)

    def _part(self, name: str) -> Path:
        return self._folder / f"{name}.parquet.part"
