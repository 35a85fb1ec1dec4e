"""The stages one after another in this process, as the workflow runs them."""

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import pandas as pd
from ruamel.yaml import YAML

import laboratory

ROOT = Path(__file__).parent.parent
ORDER = ("plan", "decode", "quality", "segment", "noise", "accelerometer", "gyroscope", "history")
SETTINGS: dict[str, dict[str, Any]] = YAML(typ="safe").load(ROOT / "config.yaml")


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


def run(campaign: Path, derived: Path, until: str = "gyroscope") -> Results:
    """Run the chain on the folder of a campaign, up to and with the stage `until`."""
    made: dict[str, Path] = {}
    raw = [path for path in campaign.iterdir() if path.name != "campaign.yaml"]
    sources: Mapping[str, list[Path]] = {
        "campaign": [campaign / "campaign.yaml"],
        "raw": raw,
        "instruments": [ROOT / "data/instruments.yaml"],
        "archive": [derived.parent / "history"],
    }
    for name in ORDER[: ORDER.index(until) + 1]:
        stage = import_module(f"stages.{name}").STAGE
        files = {file: sources[file] for file in stage.files}
        stage.run(made, files, derived / name, SETTINGS.get(name, {}))
        for table in stage.writes:  # by its own name, and by that of its stage where two write one
            made[table] = made[f"{name}_{table}"] = derived / name / f"{table}.parquet"
    return Results(derived)


def demo(**changes: Any) -> dict[str, Any]:
    """The description of the demo as a plain dict, without effects and faults but for `changes`."""
    document = laboratory.read(ROOT / "data/simulated/demo.yaml").document
    return {**document, "effects": {}, "faults": [], **changes}


def simulate(document: Mapping[str, Any], folder: Path) -> Path:
    """Let the simulated laboratory record a campaign into `folder`."""
    laboratory.write(laboratory.perform(laboratory.specify(document)), folder)
    return folder
