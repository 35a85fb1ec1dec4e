"""Behind a table: the stages that led to it, and whether each still rests on what it read.

Every table carries what made it: stage, settings, the hash of the code and of each file read
(`contracts/parquet.py`). The walk goes from a table to the files it was made from, and on until
only files are left that no stage made.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from inertial.tables.code import ROOT, code_of, hash_of, hash_of_file
from inertial.tables.errors import Refusal
from inertial.tables.parquet import provenance

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
        """The place of what a table calls `folder/file` where it tells its inputs."""
        if file.endswith(".parquet"):
            return self.derived / file
        return ROOT / file if file == INSTRUMENTS else self.raw / Path(file).name


@dataclass
class Origin:
    """One run of a stage, by the tables it gave: what made them, and what does not hold."""

    stage: str
    tables: list[str]  # folder/file, those that were read further down the pipeline
    settings: Mapping[str, Any]
    code: str
    inputs: Mapping[str, str]  # folder/file → SHA-256 when it was read
    broken: list[str] = field(default_factory=list)


class Origins:
    """Every stage behind some tables, from the last to the first.

    `tables`: folder/file; `current`: the settings of today, one section per stage.
    """

    def __init__(
        self, campaign: Campaign, tables: Sequence[str], current: Mapping[str, Any]
    ) -> None:
        self._campaign = campaign
        self._current = current
        self._hashes: dict[str, str | None] = {}
        self._by_stage: dict[str, Origin] = {}
        self._finished: list[str] = []
        self._seen: set[str] = set()
        self._untold: list[str] = []
        for table in tables:
            if table not in self._seen:
                self._visit(table)
            if origin := self._by_stage.get(table.partition("/")[0]):
                origin.broken += self._made_from_another(table)

    @property
    def stages(self) -> list[Origin]:
        """From the last stage up the pipeline; each stands before those that it read from."""
        return [self._by_stage[stage] for stage in reversed(self._finished)]

    @property
    def broken(self) -> list[str]:
        """What does not hold, in sentences, from the number up the pipeline."""
        return [*self._untold, *(told for origin in self.stages for told in origin.broken)]

    def files(self) -> dict[str, tuple[str, str | None]]:
        """The files that no stage made: SHA-256 when they were read, and now."""
        read = {file: sha for origin in self.stages for file, sha in origin.inputs.items()}
        return {
            file: (sha, self._now(file))
            for file, sha in sorted(read.items())
            if not file.endswith(".parquet")
        }

    def _visit(self, table: str) -> None:
        self._seen.add(table)
        path = self._campaign.path(table)
        stage = table.partition("/")[0]
        try:
            made_by = provenance(path)
        except Refusal:
            if path.is_file():  # else whoever read it says what has become of it
                self._untold.append(f"{path} does not tell what made it: no stage wrote it so.")
            return
        settings, code, inputs = (made_by[key] for key in ("settings", "code", "inputs"))
        known = self._by_stage.get(stage)
        if known is not None:
            known.tables.append(table)
            if (known.settings, known.code, known.inputs) != (settings, code, inputs):
                known.broken.append(
                    f"{path} and {self._campaign.path(known.tables[0])} are of different runs of"
                    f" {stage}: settings, code or inputs differ."
                )
            return
        origin = Origin(stage, [table], settings, code, inputs)
        self._by_stage[stage] = origin
        origin.broken += [*self._changed_settings(origin), *self._changed_code(origin, path)]
        for file, recorded in inputs.items():
            origin.broken += self._changed_file(stage, file, recorded)
            if file.endswith(".parquet") and file not in self._seen:
                self._visit(file)
        self._finished.append(stage)

    def _changed_file(self, stage: str, file: str, recorded: str) -> list[str]:
        path, now = self._campaign.path(file), self._now(file)
        if now is None:
            return [f"{path} is missing, which {stage} read."]
        if now == recorded:
            return []
        return [f"{path} has changed since {stage} read it: SHA-256 was {recorded}, is {now}."]

    def _changed_settings(self, origin: Origin) -> list[str]:
        now = self._current.get(origin.stage) or {}
        return [
            f"The setting {name} of {origin.stage} has changed since its tables were made: was"
            f" {origin.settings.get(name, 'not there')}, is {now.get(name, 'not there')}."
            for name in sorted({*origin.settings, *now})
            if origin.settings.get(name) != now.get(name)
        ]

    def _changed_code(self, origin: Origin, table: Path) -> list[str]:
        files = code_of(origin.stage)
        now = hash_of(files)
        if now == origin.code:
            return []
        made = table.stat().st_mtime
        newer = [str(file.relative_to(ROOT)) for file in files if file.stat().st_mtime > made]
        told = f" Newer than {table}: {', '.join(newer)}." if newer else ""
        return [
            f"The code of {origin.stage} has changed since its tables were made: SHA-256 was"
            f" {origin.code}, is {now}.{told}"
        ]

    def _made_from_another(self, table: str) -> list[str]:
        """Tables further down the pipeline that were made when `table` was another one."""
        now = self._now(table)
        told = []
        for path in sorted(self._campaign.derived.glob("*/*.parquet")):
            try:
                recorded = provenance(path)["inputs"].get(table)
            except Refusal:
                continue
            if recorded not in (None, now):
                told.append(
                    f"{self._campaign.path(table)} has changed since {path} was made from it:"
                    f" SHA-256 was {recorded}, is {now}."
                )
        return told

    def _now(self, file: str) -> str | None:
        """SHA-256 of a file as it is now; each file is read once, for logs are long."""
        path = self._campaign.path(file)
        if file not in self._hashes:
            self._hashes[file] = hash_of_file(path) if path.is_file() else None
        return self._hashes[file]
