"""How a stage meets the outside: one function from tables to tables, and its command line.

    python -m stages <stage> data/derived/<campaign> --settings '{"level": 0.005}'

It reads the tables that it declares from the folders of earlier stages in the folder of the
campaign, and writes its own into the folder of its name there; or documents, into `reports/`.
"""

import argparse
import inspect
import json
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq

from inertial.tables.code import code_of, hash_of, hash_of_file
from inertial.tables.declared import Declared
from inertial.tables.errors import Refusal, no_permission
from inertial.tables.parquet import Rows, Writer, provenance
from inertial.tables.table import Table
from inertial.tables.whole_files import room_for, write_whole
from inertial.text.numbers import visible

# What a stage returns: its tables by name, or, where one is too long for memory, pieces of them
# one after another.
Tables = Mapping[str, Rows]
Pieces = Iterator[tuple[str, Rows]]


@dataclass(frozen=True)
class Stage:
    """A stage: its function, and what it declares to read and write.

    `gathers`: arguments of the function that are made from other inputs; the function or class that
    makes one names them as its own arguments, those made before it included. A function that takes
    `provenance` gets what made each of the tables, by argument; that of documents also what makes
    them, by the name of the stage.
    """

    function: Callable[..., Any]
    declared: Declared
    gathers: Mapping[str, Callable[..., Any]] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The name of its function, which is that of its folder."""
        return self.function.__name__

    @property
    def _functions(self) -> list[Callable[..., Any]]:
        """Its function, and those that make arguments of it."""
        return [self.function, *self.gathers.values()]

    @property
    def reads(self) -> Mapping[str, Table]:
        """The contracts of the tables that it reads, by argument."""
        return {name: source.table for name, source in self.declared.reads.items()}

    @property
    def writes(self) -> Mapping[str, Table]:
        """The contracts of the tables that it writes, by file name."""
        return self.declared.writes

    def paths(self, derived: Path) -> dict[str, Path]:
        """Where the tables that it reads lie in the folder of a campaign."""
        return {name: derived / source.place for name, source in self.declared.reads.items()}

    def inputs(self, paths: Mapping[str, Path]) -> dict[str, Any]:
        """The tables that it reads, by argument: a stream where it declares one.

        Raises
        ------
        Refusal
            where a table is missing, damaged, or of another version
        """
        streams = self.declared.streams
        read: dict[str, Any] = {
            name: table.stream(paths[name]) if name in streams else table.read(paths[name])
            for name, table in self.reads.items()
        }
        if any("provenance" in inspect.signature(f).parameters for f in self._functions):
            read["provenance"] = {name: provenance(paths[name]) for name in self.reads}
            if self.declared.documents:
                made_by = self._made_by({}) | {"inputs": _hashes([*paths.values()])}
                read["provenance"] |= {self.name: made_by}
        return read

    def result(self, inputs: Mapping[str, Any]) -> Any:
        """What its function makes of tables, files and settings."""
        known = dict(inputs)
        for name, make in self.gathers.items():
            known[name] = _called(make, known)
        return _called(self.function, known)

    def _made_by(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        code = hash_of(code_of(self.name))
        return {"stage": self.name, "settings": dict(settings), "code": code}

    def run(
        self,
        derived: Path,
        files: Mapping[str, Sequence[Path]],
        settings: Mapping[str, Any],
        documents: Path | None = None,
    ) -> None:
        """Read the tables of a campaign, work, and write its own beside them, all or nothing.

        `documents`: where its documents go, but for their endings.

        Raises
        ------
        Refusal
            where an input cannot be used
        """
        paths, output = self.paths(derived), derived / self.name
        inputs = {**self.inputs(paths), **files, **settings}
        if self.declared.documents:
            assert documents is not None
            texts = self.result(inputs)
            contents = {end: t if isinstance(t, bytes) else t.encode() for end, t in texts.items()}
            write_whole({Path(f"{documents}.{end}"): contents[end] for end in contents})
            return
        made_from = [*paths.values(), *chain.from_iterable(files.values())]
        made_by = self._made_by(settings)
        with ThreadPoolExecutor(1) as beside, room_for(output):
            hashes = beside.submit(_hashes, made_from)  # a long log while it is read
            with Writer(
                output, self.writes, lambda: made_by | {"inputs": hashes.result()}
            ) as writer:
                result = self.result(inputs)
                for name, rows in result.items() if isinstance(result, Mapping) else result:
                    writer.write(name, rows)
            for name in self.declared.unfolded:
                _unfold(output / name)

    def command_line(self, arguments: Sequence[str] | None = None) -> None:
        """The folder of the campaign, `--settings JSON`, and `--NAME PATH` for files."""
        parser = argparse.ArgumentParser(description=self.function.__doc__)
        parser.add_argument("derived", type=Path, help="data/derived/<campaign>")
        parser.add_argument("--settings", type=json.loads, default={}, help="its settings, JSON")
        for name in self.declared.files:
            parser.add_argument(f"--{name}", type=Path, nargs="*", default=[], help="files")
        if self.declared.documents:
            endings = ", ".join(self.declared.documents)
            parser.add_argument(
                "--documents",
                type=Path,
                required=True,
                help=f"reports/<campaign>, before {endings}",
            )
        given = vars(parser.parse_args(arguments))
        files = {name: given[name] for name in self.declared.files}
        try:
            self.run(given["derived"], files, given["settings"], given.get("documents"))
        except Refusal as refusal:
            sys.exit(visible(f"{self.name}: {refusal}"))
        except PermissionError as error:
            sys.exit(visible(f"{self.name}: {no_permission(error)}"))


def _called(function: Callable[..., Any], known: Mapping[str, Any]) -> Any:
    """A function of those of its arguments that are known; of all that is known if it takes it."""
    own = inspect.signature(function).parameters
    every = any(one.kind is one.VAR_KEYWORD for one in own.values())
    return function(**{name: value for name, value in known.items() if every or name in own})


def _hashes(files: Sequence[Path]) -> dict[str, str]:
    """SHA-256 of each file, by its folder and name."""
    return {
        f"{path.parent.name}/{path.name}": hash_of_file(path) for path in files if path.is_file()
    }


def _unfold(folder: Path) -> None:
    """The rows of a table beside the folder as files in it, in place of those of an earlier run."""
    for old in folder.glob("*"):
        old.unlink()
    rows = pq.read_table(f"{folder}.parquet", columns=["file", "text"]).to_pylist()
    if rows:
        folder.mkdir(exist_ok=True)
        write_whole({folder / row["file"]: row["text"].encode() for row in rows})
