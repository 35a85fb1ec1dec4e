"""A table contract, and the only place that reads or writes Parquet."""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import pyarrow as pa
import pyarrow.parquet as pq

from inertial.tables.errors import Refusal

if TYPE_CHECKING:  # decode streams record batches and starts faster without pandas
    import pandas as pd

BATCH_ROWS = 65536  # rows that a stream holds in memory at a time
AGAIN = "delete the file and run the campaign again"


@dataclass(frozen=True)
class Column:
    """One column: what its numbers mean, in which unit and frame."""

    name: str
    type: pa.DataType
    unit: str
    meaning: str
    frame: str = ""
    nullable: bool = False
    noisy: bool = False  # not packed: to do so takes longer than the room is worth


@dataclass(frozen=True)
class Table:
    """Whoever reads this table gets these columns, in this order.

    `version` counts up with every change of the columns or of what they mean.
    """

    name: str
    version: int
    columns: tuple[Column, ...]

    @cached_property
    def schema(self) -> pa.Schema:
        """The Arrow schema, with unit, frame and meaning of each column in its metadata."""
        return pa.schema(
            [
                pa.field(
                    column.name,
                    column.type,
                    column.nullable,
                    {"unit": column.unit, "frame": column.frame, "meaning": column.meaning},
                )
                for column in self.columns
            ],
            {"table": self.name, "version": str(self.version)},
        )

    @property
    def packing(self) -> dict[str, Any]:
        """How Parquet writes the columns: numbers byte by byte, the first of each, the second, …

        What is full of noise stays as it is; the rest, texts among them, becomes a dictionary of
        the values that there are.
        """
        noisy = {c.name for c in self.columns if c.noisy}
        numbers = {c.name for c in self.columns if _is_number(c.type)} - noisy
        return {
            "compression": {c.name: "none" if c.name in noisy else "lz4" for c in self.columns},
            "use_dictionary": [c.name for c in self.columns if c.name not in numbers | noisy],
            "column_encoding": dict.fromkeys(numbers, "BYTE_STREAM_SPLIT"),
            "write_statistics": False,  # nobody here skips parts of a table by them
            "max_rows_per_page": BATCH_ROWS,
            "write_batch_size": BATCH_ROWS,
        }

    def read(self, path: Path) -> pd.DataFrame:
        """The whole table; for tables that are small."""
        with _readable(path):
            self._check(path, pq.read_schema(path))
            frame: pd.DataFrame = pq.read_table(path).to_pandas()
        return frame

    def stream(self, path: Path) -> Stream:
        """The table batch by batch, as often as wanted; for tables that may be large."""
        with _readable(path):
            self._check(path, pq.read_schema(path))
        return Stream(path)

    def write_once(self, path: Path, rows: pd.DataFrame) -> None:
        """Write a file that never changes again; where there is one already, that one stays.

        It is written beside its place and then linked there whole. The link fails where
        another process was first, so nobody waits and no lock is left after a kill.
        """
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f"{path.name}.{secrets.token_hex(4)}.part")
        try:
            with part.open("xb") as file:
                pq.write_table(self.arrow(rows), file, **self.packing)
                file.flush()
                os.fsync(file.fileno())
            with suppress(FileExistsError):
                path.hardlink_to(part)
        finally:
            part.unlink(missing_ok=True)

    def arrow(self, rows: pd.DataFrame | pa.RecordBatch) -> pa.Table:
        """`rows` in the columns of the contract.

        Raises
        ------
        ValueError
            where a column is missing, or has gaps that the contract does not allow
        """
        if isinstance(rows, pa.RecordBatch):
            table = pa.Table.from_batches([rows]).select(self.schema.names).cast(self.schema)
        else:
            columns = [column.name for column in self.columns]
            if missing := [name for name in columns if name not in rows]:
                raise ValueError(f"the {self.name} table lacks {', '.join(missing)}")
            table = pa.Table.from_pandas(rows[columns], schema=self.schema, preserve_index=False)
        for column in self.columns:
            if not column.nullable and table[column.name].null_count:
                raise ValueError(f"the {self.name} table has gaps in {column.name}")
        return table.replace_schema_metadata(self.schema.metadata)

    def empty(self) -> pd.DataFrame:
        """A table without rows."""
        frame: pd.DataFrame = self.schema.empty_table().to_pandas()
        return frame

    def _check(self, path: Path, schema: pa.Schema) -> None:
        told = {key.decode(): value.decode() for key, value in (schema.metadata or {}).items()}
        found = f"{told.get('table')} table of version {told.get('version')}"
        expected = f"{self.name} table of version {self.version}"
        if found != expected:
            raise Refusal(str(path), "", found, expected, AGAIN)


def _is_number(of: pa.DataType) -> bool:
    return bool(pa.types.is_integer(of) or pa.types.is_floating(of))


@dataclass(frozen=True)
class Stream:
    """A table on disk that is read batch by batch; every loop over it starts anew."""

    path: Path

    def __iter__(self) -> Iterator[pa.RecordBatch]:
        return self._batches(None)

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        """The same, of some columns only."""
        return self._batches(names)

    def _batches(self, names: list[str] | None) -> Iterator[pa.RecordBatch]:
        # A buffer beforehand would hold all that is read, up to the end.
        with _readable(self.path), pq.ParquetFile(self.path, pre_buffer=False) as file:
            yield from file.iter_batches(batch_size=BATCH_ROWS, columns=names)


def provenance(path: Path) -> dict[str, Any]:
    """What made the table at `path`: stage, settings, hash of its code, hashes of its inputs."""
    with _readable(path):
        metadata = pq.read_metadata(path).metadata or {}
    if b"made_by" not in metadata:
        raise Refusal(str(path), "", "no word of what made it", "a table of a stage", AGAIN)
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
        raise Refusal(str(path), "", f"damage: {damage}", "a Parquet table", AGAIN) from None


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
        self._open = ExitStack()

    def __enter__(self) -> Self:
        self._folder.mkdir(parents=True, exist_ok=True)
        try:
            for name, table in self._tables.items():
                writer = pq.ParquetWriter(self._part(name), table.schema, **table.packing)
                self._files[name] = self._open.enter_context(writer)
        except OSError:
            self._remove_parts()
            raise
        return self

    def write(self, name: str, rows: pd.DataFrame | pa.RecordBatch) -> None:
        """Add `rows` to the table `name`."""
        self._files[name].write_table(self._tables[name].arrow(rows))

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
                    for file in self._files.values():
                        file.add_key_value_metadata({b"made_by": made_by})
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
