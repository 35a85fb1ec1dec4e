"""How a stage meets the outside: one function from tables to tables, and its command line."""

from __future__ import annotations

import argparse
import inspect
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from stages.contracts.code import code_of, hash_of, hash_of_file
from stages.contracts.errors import Refusal
from stages.contracts.parquet import Table, Writer, provenance

if TYPE_CHECKING:
    import pandas as pd

# What a stage gives back: its tables by name, or, where one is too long for memory, pieces of
# them one after another.
Tables = Mapping[str, "pd.DataFrame"]
Pieces = Iterator[tuple[str, "pd.DataFrame | pa.RecordBatch"]]


def command_line(
    stage: Callable[..., Tables | Pieces],
    *,
    reads: Mapping[str, Table],
    writes: Mapping[str, Table],
    streams: Sequence[str] = (),
    files: Sequence[str] = (),
    arguments: Sequence[str] | None = None,
) -> None:
    """Run `stage` on files: `--NAME PATH` for each table it reads, `--output FOLDER`, `--settings`.

    A table listed in `streams` is handed over unread, to be looped over batch by
    batch; an input listed in `files` as the list of its paths. A stage whose
    function takes `provenance` gets what made each of its tables.
    """
    parser = argparse.ArgumentParser(description=stage.__doc__)
    for name, table in reads.items():
        parser.add_argument(f"--{name}", type=Path, required=True, help=f"{table.name} table")
    for name in files:
        parser.add_argument(f"--{name}", type=Path, action="append", default=[], help="input file")
    parser.add_argument("--output", type=Path, required=True, help="folder for the tables")
    parser.add_argument("--settings", type=json.loads, default={}, help="section of config.yaml")
    given = parser.parse_args(arguments)

    name_of_stage = stage.__module__.rpartition(".")[2]
    if name_of_stage == "__main__":
        name_of_stage = stage.__name__
    paths: dict[str, Path] = {name: getattr(given, name) for name in reads}
    others: dict[str, list[Path]] = {name: getattr(given, name) for name in files}
    try:
        inputs: dict[str, Any] = {
            name: table.stream(paths[name]) if name in streams else table.read(paths[name])
            for name, table in reads.items()
        }
        if "provenance" in inspect.signature(stage).parameters:
            inputs["provenance"] = {name: provenance(path) for name, path in paths.items()}
        made_by = {
            "stage": name_of_stage,
            "settings": given.settings,
            "code": hash_of(code_of(name_of_stage)),
            "inputs": {
                f"{path.parent.name}/{path.name}": hash_of_file(path)
                for path in [*paths.values(), *(p for many in others.values() for p in many)]
                if path.is_file()
            },
        }
        with Writer(given.output, writes, made_by) as writer:
            result = stage(**inputs, **others, **given.settings)
            for name, rows in result.items() if isinstance(result, Mapping) else result:
                writer.write(name, rows)
    except Refusal as refusal:
        sys.exit(f"{name_of_stage}: {refusal}")
