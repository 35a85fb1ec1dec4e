"""The stages one after another in this process, as the workflow runs them."""

import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from copy import deepcopy
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
from in_memory import MemoryStream, recorded
from ruamel.yaml import YAML

import laboratory
import stages
from inertial.campaign.campaign_data import CampaignData, CampaignTables, campaigns_of
from inertial.tables.declared import FITTED, RECORDED
from inertial.tables.stage import Stage

ROOT = Path(__file__).parent.parent
ORDER = stages.ORDER[: stages.ORDER.index("export")]
BESIDE = ("studies", "comparison")  # stages on which no later one rests, for `without`
SETTINGS: dict[str, dict[str, Any]] = YAML(typ="safe").load(ROOT / "config.yaml")


def up_to(last: str) -> tuple[str, ...]:
    """The stages until one, with it."""
    return tuple(ORDER[: ORDER.index(last) + 1])


def stage_of(name: str) -> Stage:
    """A stage by its name."""
    stage: Stage = import_module(f"stages.{name}.stage").STAGE
    return stage


class Results:
    """The tables that a run has made: `results["gyroscope/parameters"]`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __getitem__(self, name: str) -> pd.DataFrame:
        return pd.read_parquet(self.folder / f"{name}.parquet")

    def __contains__(self, name: str) -> bool:
        return (self.folder / f"{name}.parquet").exists()

    def parameters(self, stage: str, method: str = "joint") -> pd.DataFrame:
        """The parameters of one method by name."""
        table = self[f"{stage}/parameters"]
        return table[table["method"] == method].set_index("parameter")


class Tables(Results, Mapping[str, pd.DataFrame]):
    """The same, of a run in memory."""

    def __init__(self) -> None:
        self.arrow: dict[str, pa.Table] = {}
        self._frames: dict[str, pd.DataFrame] = {}

    def __getitem__(self, name: str) -> pd.DataFrame:
        if name not in self._frames:
            self._frames[name] = self.arrow[name].to_pandas()
        return self._frames[name]

    def __contains__(self, name: object) -> bool:
        return name in self.arrow

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrow)

    def __len__(self) -> int:
        return len(self.arrow)

    def copy(self) -> "Tables":
        """The same tables, to which others may be added."""
        other = Tables()
        other.arrow, other._frames = dict(self.arrow), dict(self._frames)
        return other

    def replaced(self, name: str, rows: pd.DataFrame) -> "Tables":
        """The same tables, one of them with other rows."""
        other, schema = self.copy(), self.arrow[name].schema
        other.arrow[name] = pa.Table.from_pandas(rows, schema, preserve_index=False)
        other._frames[name] = rows
        return other

    def add(self, stage: Stage, result: Any) -> None:
        """Keep what a stage returned, in the columns of its contracts."""
        pieces = result.items() if isinstance(result, Mapping) else result
        made: dict[str, list[pa.Table]] = {name: [] for name in stage.writes}
        for name, rows in pieces:
            made[name].append(stage.writes[name].arrow(rows))
        for name, parts in made.items():
            empty = stage.writes[name].schema.empty_table()
            self.arrow[f"{stage.name}/{name}"] = pa.concat_tables(parts or [empty])


def in_memory(
    recording: laboratory.Recording,
    until: str = "gyroscope",
    without: Collection[str] = (),
    onto: Tables | None = None,
    edit: Callable[[str], str] | None = None,
) -> Tables:
    """The chain on a recording of the laboratory up to and with `until`; tables stay in memory.

    `without`: as in `run`; `onto`: tables of an earlier run, to which the others are
    added; `edit`: what is changed in the campaign file that the laboratory writes.
    """
    tables = Tables() if onto is None else onto
    done = {name.partition("/")[0] for name in tables}
    with (
        tempfile.TemporaryDirectory() as folder,
        recorded(recording, Path(folder) / "raw") as campaign,
    ):
        if edit is not None:
            file = campaign / "campaign.yaml"
            file.write_text(edit(file.read_text(encoding="utf-8")), encoding="utf-8")
        sources = _sources(campaign, Path(folder))
        for name in ORDER[: ORDER.index(until) + 1]:
            if name not in done and name not in without:
                stage = stage_of(name)
                inputs = {file: sources.get(file, []) for file in stage.declared.files}
                tables.add(stage, stage.result({**inputs, **_inputs(stage, tables, name)}))
    return tables


def in_memory_of(
    document: Mapping[str, Any], until: str = "gyroscope", without: Collection[str] = ()
) -> Tables:
    """A campaign of the laboratory by its description, and the chain on it, as `in_memory`."""
    return in_memory(laboratory.perform(laboratory.specify(document)), until, without)


def _inputs(stage: Stage, tables: Tables, name: str) -> dict[str, Any]:
    """The tables that a stage reads, and its settings."""
    streams = stage.declared.streams
    inputs: dict[str, Any] = {}
    for argument, source in stage.declared.reads.items():
        place = source.place.removesuffix(".parquet")
        streamed = argument in streams
        inputs[argument] = MemoryStream(tables.arrow[place]) if streamed else tables[place]
    return inputs | SETTINGS.get(name, {})


def _sources(campaign: Path, archive: Path) -> Mapping[str, list[Path]]:
    """The files that stages read, by the names of their declarations."""
    told = {"campaign.yaml", "published.yaml"}
    return {
        "campaign": [campaign / "campaign.yaml"],
        "raw": [path for path in campaign.iterdir() if path.name not in told],
        "instruments": [ROOT / "data/instruments.yaml"],
        "published": list(campaign.glob("published.yaml")),
        "laboratory": [],
        "archive": [archive / "history"],
    }


def run(
    campaign: Path, derived: Path, until: str = "gyroscope", without: Collection[str] = ()
) -> Results:
    """Run the chain on the folder of a campaign, up to and with the stage `until`.

    `without`: stages that are left out, because no later one needs them.
    """
    sources = _sources(campaign, derived.parent)
    for name in ORDER[: ORDER.index(until) + 1]:
        if name in without:
            continue
        stage = stage_of(name)
        files = {file: sources.get(file, []) for file in stage.declared.files}
        stage.run(derived, files, SETTINGS.get(name, {}))
    return Results(derived)


def mounts(results: Results, **changes: Any) -> list[CampaignData]:
    """The campaign as later stages take it, with the joint result where there is one."""
    sources = RECORDED | FITTED
    places = {name: source.place.removesuffix(".parquet") for name, source in sources.items()}
    read = {name: results[place] for name, place in places.items() if place in results}
    return campaigns_of(CampaignTables(**read | changes))


def again(results: Results, name: str, **changes: Any) -> dict[str, pd.DataFrame]:
    """The tables of a stage, run once more on those of an earlier run, some of them changed."""
    stage = stage_of(name)
    inputs = stage.inputs(stage.paths(results.folder))
    pieces = stage.result({**inputs, **SETTINGS.get(name, {}), **changes})
    collected: dict[str, list[pd.DataFrame]] = {table: [] for table in stage.writes}
    for table, rows in pieces.items() if isinstance(pieces, Mapping) else pieces:
        collected[table].append(stage.writes[table].arrow(rows).to_pandas())
    return {
        table: pd.concat(rows, ignore_index=True) if rows else stage.writes[table].empty()
        for table, rows in collected.items()
    }


def demo(**changes: Any) -> dict[str, Any]:
    """The description of the demo as a plain dict, without effects and faults but for `changes`."""
    return {**deepcopy(_demo()), "effects": {}, "faults": [], **changes}


@cache
def _demo() -> Mapping[str, Any]:
    return laboratory.read(ROOT / "data/simulated/demo.yaml").document


def short(**changes: Any) -> dict[str, Any]:
    """The demo's campaign in two minutes: six rests of 20 s, six turns at 60 °/s, no effects."""
    document = demo(**changes)
    document["handling"]["still_s"] = 3
    document["campaign"]["plan"] = [
        {"id": f"{axis}-{way}", "do": "rest", "up": up + axis, "seconds": 20}
        for axis in "xyz"
        for way, up in (("up", "+"), ("down", "-"))
    ] + [
        {"id": f"{axis}-{way}", "do": "turn", "up": f"+{axis}", "degrees": degrees}
        | {"rate_deg_s": 60, "accel_deg_s2": 60}
        for axis in "xyz"
        for way, degrees in (("forward", 360), ("backward", -360))
    ]
    for manoeuvre in document["campaign"]["plan"]:
        manoeuvre["log"] = f"{manoeuvre['id']}.asc"
    return document


def simulate(document: Mapping[str, Any], folder: Path) -> Path:
    """Let the simulated laboratory record a campaign into `folder`."""
    laboratory.write(laboratory.perform(laboratory.specify(document)), folder)
    return folder
