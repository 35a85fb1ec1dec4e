"""The stages behind a table, and whether their files are still those they read.

Every table carries its provenance: stage, settings, the hash of the code and of each file read.
From a table it leads to the tables it was made from, and on to the files that no stage made.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from inertial.tables.code import ROOT, code_of, hash_of, hash_of_file
from inertial.tables.errors import Refusal
from inertial.tables.parquet import provenance
from inertial.text.messages import _

INSTRUMENTS = "data/instruments.yaml"  # the one input that lies beside the code, not the data


@dataclass(frozen=True)
class Campaign:
    """Where the files of a campaign are: `data/raw/<name>` and `data/derived/<name>`."""

    data: Path
    name: str

    @property
    def raw(self) -> Path:
        """The folder of campaign.yaml and the logs."""
        return self.data / "raw" / self.name

    @property
    def derived(self) -> Path:
        """The folder that holds a folder of tables for each stage."""
        return self.data / "derived" / self.name

    def path(self, file: str) -> Path:
        """The path of an input that a provenance names `folder/file`."""
        if file.endswith(".parquet"):
            return self.derived / file
        return ROOT / file if file == INSTRUMENTS else self.raw / Path(file).name


@dataclass
class StageRun:
    """One run of a stage: its tables, their provenance, and the broken links in sentences."""

    stage: str
    tables: list[str]  # folder/file, those that later stages have read
    settings: Mapping[str, Any]
    code: str
    inputs: Mapping[str, str]  # folder/file → SHA-256 when it was read
    broken: list[str] = field(default_factory=list)


class Provenance:
    """Every stage behind some tables, from the last to the first.

    `tables`: folder/file; `current_settings`: one section per stage.
    """

    def __init__(
        self, campaign: Campaign, tables: Sequence[str], current_settings: Mapping[str, Any]
    ) -> None:
        self._campaign = campaign
        self._current_settings = current_settings
        self._hashes: dict[str, str | None] = {}
        self._by_stage: dict[str, StageRun] = {}
        self._finished: list[str] = []
        self._visited: set[str] = set()
        self._without_provenance: list[str] = []
        for table in tables:
            if table not in self._visited:
                self._visit(table)
            if run := self._by_stage.get(table.partition("/")[0]):
                run.broken += self._later_tables_of_another(table)

    @property
    def runs(self) -> list[StageRun]:
        """From the last stage up the pipeline; each stands before those that it read from."""
        return [self._by_stage[stage] for stage in reversed(self._finished)]

    @property
    def broken(self) -> list[str]:
        """The broken links in sentences, from the number up the pipeline."""
        return [*self._without_provenance, *(link for run in self.runs for link in run.broken)]

    def files(self) -> dict[str, tuple[str, str | None]]:
        """The files that no stage made: SHA-256 when they were read, and now."""
        read = {file: sha for run in self.runs for file, sha in run.inputs.items()}
        return {
            file: (sha, self._current_hash(file))
            for file, sha in sorted(read.items())
            if not file.endswith(".parquet")
        }

    def _visit(self, table: str) -> None:
        self._visited.add(table)
        path = self._campaign.path(table)
        stage = table.partition("/")[0]
        try:
            made_by = provenance(path)
        except Refusal:
            if path.is_file():  # a missing one is reported with the stage that read it
                self._without_provenance.append(
                    _("{path} has no provenance: it was not written by a stage.", path=path)
                )
            return
        settings, code, inputs = (made_by[key] for key in ("settings", "code", "inputs"))
        known = self._by_stage.get(stage)
        if known is not None:
            known.tables.append(table)
            if (known.settings, known.code, known.inputs) != (settings, code, inputs):
                known.broken.append(
                    _(
                        "{path} and {tables} are of different runs of {stage}: settings, code or "
                        "inputs differ.",
                        path=path,
                        tables=self._campaign.path(known.tables[0]),
                        stage=stage,
                    )
                )
            return
        run = StageRun(stage, [table], settings, code, inputs)
        self._by_stage[stage] = run
        run.broken += [*self._changed_settings(run), *self._changed_code(run, path)]
        for file, recorded in inputs.items():
            run.broken += self._changed_file(stage, file, recorded)
            if file.endswith(".parquet") and file not in self._visited:
                self._visit(file)
        self._finished.append(stage)

    def _changed_file(self, stage: str, file: str, recorded: str) -> list[str]:
        path, current = self._campaign.path(file), self._current_hash(file)
        if current is None:
            return [_("{path} is missing, which {stage} read.", path=path, stage=stage)]
        if current == recorded:
            return []
        return [
            _(
                "{path} has changed since {stage} read it: SHA-256 was {recorded}, is {current}.",
                path=path,
                stage=stage,
                recorded=recorded,
                current=current,
            )
        ]

    def _changed_settings(self, run: StageRun) -> list[str]:
        current = self._current_settings.get(run.stage) or {}
        return [
            _(
                "The setting {name} of {stage} has changed since its tables were made: was "
                "{name_2}, is {name_3}.",
                name=name,
                stage=run.stage,
                name_2=run.settings.get(name, "not there"),
                name_3=current.get(name, "not there"),
            )
            for name in sorted({*run.settings, *current})
            if run.settings.get(name) != current.get(name)
        ]

    def _changed_code(self, run: StageRun, table: Path) -> list[str]:
        files = code_of(run.stage)
        current = hash_of(files)
        if current == run.code:
            return []
        written = table.stat().st_mtime
        newer = [str(file.relative_to(ROOT)) for file in files if file.stat().st_mtime > written]
        listed = (
            _(" Newer than {table}: {newer}.", table=table, newer=", ".join(newer)) if newer else ""
        )
        return [
            _(
                "The code of {stage} has changed since its tables were made: SHA-256 was "
                "{code}, is {current}.{listed}",
                stage=run.stage,
                code=run.code,
                current=current,
                listed=listed,
            )
        ]

    def _later_tables_of_another(self, table: str) -> list[str]:
        """Tables further down the pipeline that were made when `table` was another one."""
        current = self._current_hash(table)
        broken = []
        for path in sorted(self._campaign.derived.glob("*/*.parquet")):
            try:
                recorded = provenance(path)["inputs"].get(table)
            except Refusal:
                continue
            if recorded not in (None, current):
                broken.append(
                    _(
                        "{table} has changed since {path} was made from it: SHA-256 was "
                        "{recorded}, is {current}.",
                        table=self._campaign.path(table),
                        path=path,
                        recorded=recorded,
                        current=current,
                    )
                )
        return broken

    def _current_hash(self, file: str) -> str | None:
        """SHA-256 of a file as it is now; each file is read once, because logs are long."""
        path = self._campaign.path(file)
        if file not in self._hashes:
            self._hashes[file] = hash_of_file(path) if path.is_file() else None
        return self._hashes[file]
