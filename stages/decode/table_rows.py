"""What was decoded as rows of the tables."""

from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import lru_cache
from typing import Any

import pyarrow as pa

from inertial.formats.account import Account, RefusedLine
from inertial.formats.arrow_arrays import (
    array_of_numbers,
    array_of_texts,
    batch_of_rows,
    repeated_text,
)
from inertial.tables import ACCOUNTS, REFUSED, SAMPLES

Pieces = Iterator[tuple[str, pa.RecordBatch]]


def account_of(log: str, account: Account, refused: list[RefusedLine]) -> Pieces:
    """What became of every byte, and the lines that were refused."""
    yield from refused_rows(log, refused)
    sums = [
        {"log": log, "kind": kind, "name": name, "lines": lines, "bytes": size}
        for kind, name, lines, size in account
    ]
    yield "accounts", batch_of_rows(sums, ACCOUNTS.schema)


def refused_rows(log: str, refused: list[RefusedLine]) -> Pieces:
    """The lines that were refused, if any."""
    if refused:
        lines = [{"log": log, **asdict(line)} for line in refused]
        yield "refused", batch_of_rows(lines, REFUSED.schema)


def sample_rows(log: str, samples: Mapping[str, Any]) -> pa.RecordBatch:
    """The samples in the columns of the table; what the log does not record is null."""
    rows = len(samples["record"])
    filled = {"log": repeated_text(log, rows)}
    for name, values in samples.items():
        if isinstance(values, list):
            filled[name] = array_of_texts(values).dictionary_encode()
        elif values is not None:
            filled[name] = array_of_numbers(values)
    arrays = [
        filled[column.name] if column.name in filled else _nulls(rows, column.type)
        for column in SAMPLES.schema
    ]
    return pa.RecordBatch.from_arrays(arrays, schema=SAMPLES.schema)


@lru_cache(4)  # most pieces have as many rows
def _nulls(rows: int, of: pa.DataType) -> pa.Array:
    """What is not recorded, (rows,)."""
    return pa.nulls(rows, of)
