"""A campaign with all that made it, as one Workflow Run RO-Crate: reports/<campaign>.crate.zip.

    python -m commands.crate --campaign june

The crate holds the logs and the campaign file, all tables and documents, the Snakefile with its
settings and the lock file, and says in `ro-crate-metadata.json` which stage of which version made
which file from which, and when (Workflow Run RO-Crate 0.5 with its Provenance Run Crate, of
RO-Crate 1.1; Leo et al. 2024). It reads the tables, which the workflow makes first. It ends with 0,
or with 2 where there are none.
"""

import argparse
import sys
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from importlib import import_module, metadata
from io import StringIO
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
from rocrate.model.contextentity import ContextEntity
from rocrate.rocrate import ROCrate

from commands import run
from inertial import tables
from inertial.campaign.records import Row, rows_of
from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.parquet import provenance
from inertial.tables.whole_files import room_for
from inertial.text.messages import _
from inertial.text.numbers import visible
from stages import ORDER

HOME = Path(__file__).parent.parent
PROJECT = "turntable-calibration"
WORKFLOW = ("Snakefile", "config.yaml", "requirements.lock")
RO = "https://w3id.org/ro"
PROFILES = {
    f"{RO}/wfrun/process/0.5": "Process Run Crate",
    f"{RO}/wfrun/workflow/0.5": "Workflow Run Crate",
    f"{RO}/wfrun/provenance/0.5": "Provenance Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
BIOSCHEMAS = "https://bioschemas.org/profiles"
CONTEXT = f"{RO}/terms/workflow-run/context"
FORMATS = {
    ".parquet": "application/vnd.apache.parquet",
    ".html": "text/html",
    ".pdf": "application/pdf",
    ".json": "application/json",
    ".yaml": "application/yaml",
    ".xml": "application/xml",
}
TEXT = "text/plain"  # of what has another ending and is text
COMPLETED = "http://schema.org/CompletedActionStatus"
LICENCE = "Data of a laboratory, which states the terms of use; none are stated here."


@dataclass(frozen=True)
class Done:
    """A stage that has run on the campaign: what it read and wrote, from when to when."""

    stage: str
    read: Sequence[Path]
    written: Sequence[Path]
    code: str  # SHA-256 of all it rests on
    start: datetime
    end: datetime


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the crate; the exit code."""
    parser = argparse.ArgumentParser(
        prog="crate", description="a campaign as a Workflow Run RO-Crate"
    )
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds raw/ and derived/")
    options = parser.parse_args(arguments)
    folder, campaign = options.data.parent, options.campaign
    file = folder / f"reports/{campaign}.crate.zip"
    try:
        crate = crate_of(folder, campaign)
        part = file.with_name(f"{file.name}.part")
        try:
            with room_for(file), part.open("wb") as stream:
                stream.writelines(crate.stream_zip())
            part.replace(file)
        finally:
            part.unlink(missing_ok=True)
    except Refusal as refusal:
        sys.stderr.write(visible(f"crate: {refusal}\n"))
        return 2
    sys.stdout.write(visible(_("The crate: {path}", path=file) + "\n"))
    return 0


def crate_of(folder: Path, campaign: str) -> ROCrate:
    """The crate of a campaign of a folder that holds data/ and reports/.

    Raises
    ------
    Refusal
        where its tables are missing
    """
    derived = folder / "data/derived" / campaign
    (facts,) = rows_of(tables.CAMPAIGN.read(derived / "plan/campaign.parquet"))
    named = rows_of(tables.INPUTS.read(derived / "plan/inputs.parquet"))
    raw = [folder / "data/raw" / campaign / row["file"] for row in named]
    hashes = dict(zip(raw, (row["sha256"] for row in named), strict=True))
    done = list(_done(folder, campaign, raw))
    return _Crate(folder, campaign, facts, hashes).of(done)


def _done(folder: Path, campaign: str, raw: Sequence[Path]) -> Iterator[Done]:
    derived = folder / "data/derived" / campaign
    for stage in ORDER:
        declared = import_module(f"stages.{stage}.declared").DECLARED
        written = [derived / stage / f"{name}.parquet" for name in declared.writes]
        written += [folder / f"reports/{campaign}.{ending}" for ending in declared.documents]
        measured = derived / stage / "benchmark.tsv"
        if not measured.is_file() or not all(path.is_file() for path in written):
            continue
        read = [derived / source.place for source in declared.reads.values()]
        if {"raw", "campaign"} & set(declared.files):
            read += raw
        if "html" in declared.files:  # the PDF, of the page and what is attached to it
            ends = ("html", "calibration.json", "dcc.xml")
            read = [folder / f"reports/{campaign}.{ending}" for ending in ends]
        # Snakemake writes the file at the end of the job; its first column are seconds.
        seconds = float(measured.read_text().splitlines()[-1].split("\t")[0])
        end = datetime.fromtimestamp(measured.stat().st_mtime, UTC)
        code = provenance(written[0])["code"] if declared.writes else hash_of(code_of(stage))
        yield Done(stage, read, written, code, end - timedelta(seconds=seconds), end)


class _Crate:
    """The crate of a campaign as it is made: `hashes` of its raw files, SHA-256."""

    def __init__(self, folder: Path, campaign: str, facts: Row, hashes: dict[Path, str]) -> None:
        self.folder, self.campaign, self.facts, self.hashes = folder, campaign, facts, hashes
        self.crate = ROCrate(version="1.1")
        self.crate.metadata.extra_contexts.append(CONTEXT)
        self.files: dict[Path, Any] = {}
        self.parameters: dict[str, Any] = {}

    def of(self, done: Sequence[Done]) -> ROCrate:
        """Root, workflow, files, and the actions."""
        self._root(done)
        workflow = self._workflow()
        inputs = [self._file(path) for path in self.hashes]
        outputs = [self._file(path) for one in done for path in one.written]
        agent = self._agent()
        steps = [self._step(one, place, agent) for place, one in enumerate(done, 1)]
        workflow["step"] = [step for step, _action, _control in steps]
        workflow["hasPart"] = [step["workExample"] for step, _action, _control in steps]
        start, end = min(one.start for one in done), max(one.end for one in done)
        told = "From the logs to tables, report and exports."
        run = self._action("run", told, workflow, start, end)
        run["object"], run["result"] = _one(inputs), _one(outputs)
        engine = self._software("snakemake", "Snakemake", metadata.version("snakemake"))
        organised = self._entity(
            "#organised",
            "OrganizeAction",
            {
                "name": f"Snakemake {metadata.version('snakemake')}",
                "startTime": _time(start),
                "endTime": _time(end),
            },
        )
        organised["instrument"] = engine
        organised["object"] = [control for _step, _action, control in steps]
        organised["result"] = run
        if agent is not None:
            run["agent"] = organised["agent"] = agent
        actions = [run, organised, *(action for _step, action, _control in steps)]
        self.crate.root_dataset["mentions"] = actions
        return self.crate

    def _root(self, done: Sequence[Done]) -> None:
        simulated = "simulated " if self.facts["simulated"] else ""
        end = max((one.end for one in done), default=datetime.now(UTC))
        profiles = [
            self._entity(
                identifier, "CreativeWork", {"name": name, "version": identifier.split("/")[-1]}
            )
            for identifier, name in PROFILES.items()
        ]
        root = self.crate.root_dataset
        root["conformsTo"] = profiles
        root["name"] = f"{self.campaign}: {simulated}calibration of an IMU"
        root["description"] = (
            f"Logs, tables, report and exports of the {simulated}campaign {self.campaign}:"
            f" {self.facts['instrument']}, serial number {self.facts['serial']},"
            f" {self.facts['date']}; with the workflow that made them."
        )
        root["datePublished"] = _time(end)
        readme = f"# {root['name']}\n\n{root['description']}\n"
        self.crate.add_file(
            StringIO(readme),
            "README.md",
            properties={"name": "README.md", "encodingFormat": "text/markdown", "about": root},
        )
        root["license"] = self._entity(
            "#licence", "CreativeWork", {"name": "Not stated", "description": LICENCE}
        )

    def _workflow(self) -> Any:
        for name in WORKFLOW[1:]:
            self._add(HOME / name, name)
        workflow = self.crate.add_workflow(
            HOME / WORKFLOW[0],
            WORKFLOW[0],
            main=True,
            lang="snakemake",
            lang_version=metadata.version("snakemake"),
            properties={
                "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
                "name": "Calibration of an IMU, from raw log to certificate",
                "encodingFormat": TEXT,
                "version": _version(),
            },
        )
        workflow["conformsTo"] = self._bioschemas("ComputationalWorkflow")
        for way, name, told, many in (
            ("input", "campaign", "the campaign file", False),
            ("input", "logs", "the logs of the IMU", True),
            ("output", "tables", "the tables of all stages", True),
            ("output", "documents", "the report, and the calibration for other programs", True),
        ):
            self.parameters[name] = parameter = self.crate.add_formal_parameter(
                name,
                "File",
                identifier=f"#parameter-{name}",
                valueRequired=not many,
                properties={"description": told, "multipleValues": many},
            )
            parameter["conformsTo"] = self._bioschemas("FormalParameter")
            workflow.append_to(way, parameter)
        return workflow

    def _bioschemas(self, name: str) -> Any:
        properties = {"name": name, "version": "1.0-RELEASE"}
        return self._entity(f"{BIOSCHEMAS}/{name}/1.0-RELEASE", "CreativeWork", properties)

    def _step(self, one: Done, place: int, agent: Any) -> tuple[Any, Any, Any]:
        """The stage as a step of the workflow, as an action, and the order to do it."""
        about = import_module(f"stages.{one.stage}").__doc__ or one.stage
        tool = self._software(f"stages.{one.stage}", f"python -m stages {one.stage}", one.code)
        about = about.strip().splitlines()[0]
        tool["description"] = about
        step = self._entity(
            f"{WORKFLOW[0]}#step-{one.stage}",
            "HowToStep",
            {"name": one.stage, "position": str(place)},
        )
        step["workExample"] = tool
        action = self._action(one.stage, about, tool, one.start, one.end)
        action["object"] = _one([self._file(path) for path in one.read if path.is_file()])
        action["result"] = _one([self._file(path) for path in one.written])
        control = self._entity(
            f"#control-{one.stage}", "ControlAction", {"name": f"Orchestration of {one.stage}"}
        )
        control["instrument"], control["object"] = step, action
        if agent is not None:
            action["agent"] = agent
        return step, action, control

    def _action(self, name: str, told: str, tool: Any, start: datetime, end: datetime) -> Any:
        action = self._entity(
            f"#action-{name}",
            "CreateAction",
            {
                "name": f"{name} on {self.campaign}",
                "description": told,
                "startTime": _time(start),
                "endTime": _time(end),
                "actionStatus": COMPLETED,
            },
        )
        action["instrument"] = tool
        return action

    def _software(self, name: str, title: str, version: str) -> Any:
        properties = {"name": title, "softwareVersion": version}
        return self._entity(f"#{name}", "SoftwareApplication", properties)

    def _agent(self) -> Any:
        """Who recorded, or the laboratory, where the campaign file says so; author, publisher."""
        root, agent = self.crate.root_dataset, None
        if isinstance(laboratory := self.facts["laboratory"], str):
            agent = self._entity("#laboratory", "Organization", {"name": laboratory})
            root["publisher"] = root["author"] = agent
        if isinstance(operator := self.facts["operator"], str):
            person = self._entity("#operator", "Person", {"name": operator})
            if agent is not None:
                person["affiliation"] = agent
            root["author"] = agent = person
        return agent

    def _file(self, path: Path) -> Any:
        """A file of the campaign, at its place in the folder."""
        if path not in self.files:
            place = path.relative_to(self.folder).as_posix()
            properties: dict[str, Any] = {}
            if path in self.hashes:
                properties["sha256"] = self.hashes[path]
                kind = "campaign" if path.name == "campaign.yaml" else "logs"
            else:
                kind = "documents" if place.startswith("reports/") else "tables"
            if path.suffix == ".parquet":
                properties["description"] = f"{pq.read_metadata(path).num_rows} rows"
            self.files[path] = entity = self._add(path, place, properties)
            entity["exampleOfWork"] = self.parameters[kind]
        return self.files[path]

    def _add(self, path: Path, place: str, more: dict[str, Any] | None = None) -> Any:
        kind = FORMATS.get(path.suffix, TEXT)
        properties = {"name": place, "encodingFormat": kind, **(more or {})}
        return self.crate.add_file(path, place, properties=properties, record_size=True)

    def _entity(self, identifier: str, kind: str, properties: dict[str, Any]) -> Any:
        found = self.crate.dereference(identifier)
        if found is not None:
            return found
        return self.crate.add(
            ContextEntity(self.crate, identifier, properties={"@type": kind, **properties})
        )


def _time(moment: datetime) -> str:
    return moment.isoformat(timespec="milliseconds")


def _one(entities: Sequence[Any]) -> Any:
    """A list, but for a single one, as RO-Crate writes it."""
    return entities[0] if len(entities) == 1 else list(entities)


def _version() -> str:
    """Of the project, installed or a checkout."""
    try:
        return metadata.version(PROJECT)
    except metadata.PackageNotFoundError:
        project = tomllib.loads((HOME / "pyproject.toml").read_text("utf-8"))["project"]
        return str(project["version"])


if __name__ == "__main__":
    run(main)
