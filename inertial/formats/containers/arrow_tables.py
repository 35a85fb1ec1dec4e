"""Columns of a Parquet file, an Arrow file or an Arrow stream, by the names of its schema.

An Arrow file is a stream between two marks, with an index behind it, so both are read from front to
back.

Source: https://parquet.apache.org/docs/file-format/
        https://arrow.apache.org/docs/format/Columnar.html
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import ipc, parquet

from inertial.formats.columns.column_values import arrow_values
from inertial.formats.containers.container import BATCH_ROWS, Batch, Table, refuse_excessive_rows

MAX_FOOTER_BYTES = 1 << 26  # of the strings and containers in a Parquet footer

_MARK = b"ARROW1"
_STREAM_OFFSET = 8  # byte of an Arrow file where the stream begins: after the mark and padding


@contextmanager
def opened_parquet(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The Parquet file at `path` as a table; columns of columns have no name of their own.

    Raises
    ------
    Refusal
        where it states more rows than it can hold
    """
    with parquet.ParquetFile(
        path,
        pre_buffer=False,
        thrift_string_size_limit=MAX_FOOTER_BYTES,
        thrift_container_size_limit=MAX_FOOTER_BYTES,
        arrow_extensions_enabled=False,
        page_checksum_verification=True,  # where there are any
    ) as file:
        refuse_excessive_rows(path, file.metadata.num_rows)
        yield Table(file.schema_arrow.names, partial(_parquet_batches, file))


def _parquet_batches(file: parquet.ParquetFile, indices: Sequence[int]) -> Iterator[Batch]:
    names = file.schema_arrow.names
    batches = file.iter_batches(
        BATCH_ROWS, columns=[names[index] for index in indices], use_threads=False
    )
    rows = 0
    for batch in batches:
        rows += batch.num_rows
        table = pa.Table.from_batches([batch])
        columns = {index: arrow_values(table[names[index]]) for index in indices}
        yield Batch(batch.num_rows, columns)
    if rows != file.metadata.num_rows:
        raise ValueError(f"{rows} rows, but {file.metadata.num_rows} in the file's own account")


@contextmanager
def opened_arrow(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The Arrow file or stream at `path` as a table.

    Raises
    ------
    ValueError
        where batches are missing
    """
    with pa.OSFile(str(path)) as source:
        is_file = source.read(len(_MARK)) == _MARK
        start = _STREAM_OFFSET if is_file else 0
        _refuse_missing_batches(source, start, is_file)
        source.seek(start)
        schema = ipc.open_stream(source).schema
        yield Table(schema.names, partial(_arrow_batches, source, start))


def _refuse_missing_batches(source: pa.NativeFile, start: int, is_file: bool) -> None:
    source.seek(start)
    batches = sum(
        message.type == "record batch" for message in ipc.MessageReader.open_stream(source)
    )
    if is_file:
        stated = ipc.open_file(source).num_record_batches
        if batches != stated:
            raise ValueError(f"{batches} batches of rows, but {stated} in the index")
    elif source.tell() != source.size():
        raise ValueError(f"the stream ends at byte {source.tell()}, the file at {source.size()}")


def _arrow_batches(source: pa.NativeFile, start: int, indices: Sequence[int]) -> Iterator[Batch]:
    source.seek(start)
    required = list(indices)
    # Without a required column one is read all the same, for the number of rows.
    options = ipc.IpcReadOptions(included_fields=required or [0], use_threads=False)
    for batch in ipc.open_stream(source, options=options):
        batch.validate(full=True)
        for first in range(0, batch.num_rows, BATCH_ROWS):
            table = pa.Table.from_batches([batch.slice(first, BATCH_ROWS)])
            columns = {
                index: arrow_values(table.column(place)) for place, index in enumerate(required)
            }
            yield Batch(table.num_rows, columns)
