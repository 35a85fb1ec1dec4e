"""Columns of an Arrow file, or of the same as a stream, by the names of its schema.

A file is a stream between two marks, with an index behind it. So both are read from front to back.

Source: https://arrow.apache.org/docs/format/Columnar.html
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import ipc

from stages.formats.arrow_claims import claimed_bytes
from stages.formats.containers import PORTION_ROWS, Portion, Table
from stages.formats.fields import field_of_arrow
from stages.formats.limits import refuse_piece

_MARK = b"ARROW1"
_BATCH = "record batch"  # what the library calls such a message
_STREAM = 8  # byte of a file where the stream begins: behind the mark, filled up to eight


@contextmanager
def opened(path: Path, layout: Mapping[str, Any]) -> Iterator[Table]:
    """The Arrow file or stream at `path` as a table.

    Raises
    ------
    Refusal
        where a batch is said to be larger than one may be unpacked
    ValueError
        where batches are missing
    """
    with pa.memory_map(str(path)) as source:
        is_file = source.read(len(_MARK)) == _MARK
        start = _STREAM if is_file else 0
        _refuse_large_batches(path, source, start, is_file)
        source.seek(start)
        schema = ipc.open_stream(source).schema
        yield Table(schema.names, partial(_portions, source, start))


def _refuse_large_batches(
    path: Path, source: pa.MemoryMappedFile, start: int, is_file: bool
) -> None:
    """Look at every message, and whether they are all that there should be."""
    source.seek(start)
    batches = 0
    for number, message in enumerate(ipc.MessageReader.open_stream(source)):
        refuse_piece(path, f"message {number}", claimed_bytes(message))
        batches += message.type == _BATCH
    if is_file:
        stated = ipc.open_file(source).num_record_batches
        if batches != stated:
            raise ValueError(f"{batches} batches of rows, but {stated} in the index")
    elif source.tell() != source.size():
        raise ValueError(f"the stream ends at byte {source.tell()}, the file at {source.size()}")


def _portions(source: pa.MemoryMappedFile, start: int, indices: Sequence[int]) -> Iterator[Portion]:
    source.seek(start)
    wanted = list(indices)
    # Without a wanted column one is read all the same, for the number of rows.
    options = ipc.IpcReadOptions(included_fields=wanted or [0], use_threads=False)
    for batch in ipc.open_stream(source, options=options):
        batch.validate(full=True)
        for first in range(0, batch.num_rows, PORTION_ROWS):
            table = pa.Table.from_batches([batch.slice(first, PORTION_ROWS)])
            columns = enumerate(wanted)
            fields = {index: field_of_arrow(table.column(place)) for place, index in columns}
            yield Portion(table.num_rows, fields)
