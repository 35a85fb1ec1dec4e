"""The stages one after another in this process, as the workflow runs them."""

from collections.abc import Collection, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import pandas as pd
from ruamel.yaml import YAML

import laboratory
import stages
from inertial.campaign.campaign_data import CampaignData, campaigns_of
from inertial.tables.stage import Stage

ROOT = Path(__file__).parent.parent
ORDER = stages.ORDER[: stages.ORDER.index("export")]
SETTINGS: dict[str, dict[str, Any]] = YAML(typ="safe").load(ROOT / "config.yaml")


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

    def parameters(self, stage: str, method: str = "joint") -> pd.DataFrame:
        """The parameters of one method by name."""
        table = self[f"{stage}/parameters"]
        return table[table["method"] == method].set_index("parameter")


def run(
    campaign: Path, derived: Path, until: str = "gyroscope", without: Collection[str] = ()
) -> Results:
    """Run the chain on the folder of a campaign, up to and with the stage `until`.

    `without`: stages that are left out, because no later one needs them.
    """
    told = {"campaign.yaml", "published.yaml"}
    raw = [path for path in campaign.iterdir() if path.name not in told]
    sources: Mapping[str, list[Path]] = {
        "campaign": [campaign / "campaign.yaml"],
        "raw": raw,
        "instruments": [ROOT / "data/instruments.yaml"],
        "published": list(campaign.glob("published.yaml")),
        "archive": [derived.parent / "history"],
    }
    for name in ORDER[: ORDER.index(until) + 1]:
        if name in without:
            continue
        stage = stage_of(name)
        files = {file: sources.get(file, []) for file in stage.declared.files}
        stage.run(derived, files, SETTINGS.get(name, {}))
    return Results(derived)


def mounts(results: Results, **changes: Any) -> list[CampaignData]:
    """The campaign as later stages take it, with the joint result where there is one."""
    tables: dict[str, Any] = {
        "manoeuvres": "segment/manoeuvres",
        "performed": "segment/performed",
        "blocks": "segment/blocks",
        "levels": "noise/levels",
        "known": "plan/known",
        "clocks": "decode/clocks",
    }
    for stage in ("accelerometer", "gyroscope"):
        if (results.folder / stage).is_dir():
            tables |= {
                f"{stage}_{of}": f"{stage}/{of}" for of in ("parameters", "positions", "fit")
            }
    return campaigns_of(**{name: results[table] for name, table in tables.items()} | changes)


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
    document = laboratory.read(ROOT / "data/simulated/demo.yaml").document
    return {**document, "effects": {}, "faults": [], **changes}


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
