"""Columns of a Parquet file, by the names of its schema.

Source: https://parquet.apache.org/docs/file-format/
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import parquet

from stages.formats.containers import PORTION_ROWS, Portion, Table
from stages.formats.fields import field_of_arrow
from stages.formats.limits import refuse_growth, refuse_piece

LARGEST_FOOTER = 1 << 26  # byte, of the strings and containers in the footer
_NUMBER_BYTES = 8


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The Parquet file at `path` as a table; columns of columns have no name of their own.

    Raises
    ------
    Refusal
        where a row group is said to be larger than one may be unpacked
    """
    with parquet.ParquetFile(
        path,
        pre_buffer=False,
        thrift_string_size_limit=LARGEST_FOOTER,
        thrift_container_size_limit=LARGEST_FOOTER,
        arrow_extensions_enabled=False,
        page_checksum_verification=True,  # where there are any
    ) as file:
        groups = file.metadata.num_row_groups
        for group in range(groups):
            stated = file.metadata.row_group(group)
            what = f"row group {group}"
            refuse_piece(path, what, max(stated.total_byte_size, _NUMBER_BYTES * stated.num_rows))
        refuse_growth(path, "its rows", file.metadata.num_rows, path.stat().st_size)
        yield Table(file.schema_arrow.names, partial(_portions, file))


def _portions(file: parquet.ParquetFile, indices: Sequence[int]) -> Iterator[Portion]:
    names = file.schema_arrow.names
    batches = file.iter_batches(
        PORTION_ROWS, columns=[names[index] for index in indices], use_threads=False
    )
    read = 0
    for batch in batches:
        read += batch.num_rows
        table = pa.Table.from_batches([batch])
        fields = {index: field_of_arrow(table[names[index]]) for index in indices}
        yield Portion(batch.num_rows, fields)
    if read != file.metadata.num_rows:
        raise ValueError(f"{read} rows, but {file.metadata.num_rows} in the file's own account")
