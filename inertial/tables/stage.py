"""How a stage meets the outside: one function from tables to tables, and its command line."""

from __future__ import annotations

import argparse
import inspect
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa

from inertial.tables.code import code_of, hash_of, hash_of_file
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Writer, provenance
from inertial.tables.table import Table
from inertial.tables.whole_files import room_for

if TYPE_CHECKING:
    import pandas as pd

# What a stage gives back: its tables by name, or, where one is too long for memory, pieces of
# them one after another.
Tables = Mapping[str, "pd.DataFrame"]
Pieces = Iterator[tuple[str, "pd.DataFrame | pa.RecordBatch"]]


@dataclass(frozen=True)
class Stage:
    """A stage: its function, the tables it reads and writes.

    A table listed in `streams` is handed over unread, to be looped over batch by
    batch; an input listed in `files` as the list of its paths. A function that takes
    `provenance` gets what made each of its tables.
    """

    function: Callable[..., Tables | Pieces]
    writes: Mapping[str, Table]
    reads: Mapping[str, Table] = field(default_factory=dict)
    streams: Sequence[str] = ()
    files: Sequence[str] = ()

    @property
    def name(self) -> str:
        """The name of its function, which is that of its file."""
        return self.function.__name__

    def run(
        self,
        paths: Mapping[str, Path],
        files: Mapping[str, list[Path]],
        output: Path,
        settings: Mapping[str, Any],
    ) -> None:
        """Read the tables at `paths`, work, and write into the folder `output`, all or nothing.

        Raises
        ------
        Refusal
            where an input cannot be used
        """
        inputs: dict[str, Any] = {
            name: table.stream(paths[name]) if name in self.streams else table.read(paths[name])
            for name, table in self.reads.items()
        }
        if "provenance" in inspect.signature(self.function).parameters:
            inputs["provenance"] = {name: provenance(paths[name]) for name in self.reads}
        made_from = [*(paths[name] for name in self.reads), *chain.from_iterable(files.values())]
        made_by = {
            "stage": self.name,
            "settings": dict(settings),
            "code": hash_of(code_of(self.name)),
        }
        with ThreadPoolExecutor(1) as beside, room_for(output):
            hashes = beside.submit(_hashes, made_from)  # a long log while it is read
            with Writer(
                output, self.writes, lambda: made_by | {"inputs": hashes.result()}
            ) as writer:
                result = self.function(**inputs, **files, **settings)
                for name, rows in result.items() if isinstance(result, Mapping) else result:
                    writer.write(name, rows)

    def command_line(self, arguments: Sequence[str] | None = None) -> None:
        """`--NAME PATH` for each input, `--output FOLDER`, `--settings JSON`."""
        parser = argparse.ArgumentParser(description=self.function.__doc__)
        for name, table in self.reads.items():
            parser.add_argument(f"--{name}", type=Path, required=True, help=f"{table.name} table")
        for name in self.files:
            parser.add_argument(f"--{name}", type=Path, action="append", default=[], help="file")
        parser.add_argument("--output", type=Path, required=True, help="folder for the tables")
        parser.add_argument("--settings", type=json.loads, default={}, help="its settings")
        given = vars(parser.parse_args(arguments))
        files = {name: given[name] for name in self.files}
        try:
            self.run(given, files, given["output"], given["settings"])
        except Refusal as refusal:
            sys.exit(f"{self.name}: {refusal}")


def _hashes(files: Sequence[Path]) -> dict[str, str]:
    """SHA-256 of each file, by its folder and name."""
    return {
        f"{path.parent.name}/{path.name}": hash_of_file(path) for path in files if path.is_file()
    }
