"""The demo's turns about z, of which the backward one has lost what S0's has."""

from math import radians
from pathlib import Path

import chain
import pandas as pd

from inertial.campaign.rate_segments import GyroInputs

NOISE = radians(0.012 / 60)  # rad/√s, of the demo
STEP = 0.01  # s
ANGLE = radians(2 / 3600)  # sigma of the table
Z_SCALE = 8  # place of M_zz among the unknowns


def z_turns(**changes) -> dict:
    """Two rests and the two turns about z, with S0's gap in the backward one."""
    document = chain.demo(**{"faults": lose((2193, 1197)), **changes})
    wanted = ("z-up", "z-down", "z-forward", "z-backward")
    plan = [entry for entry in document["campaign"]["plan"] if entry["id"] in wanted]
    document["campaign"]["plan"] = [
        entry | ({"seconds": 60} if entry["do"] == "rest" else {}) for entry in plan
    ]
    return document


def lose(*stretches: tuple[int, int]) -> list[dict]:
    """Faults of the laboratory: from a line of the backward turn's log so many samples are lost."""
    return [
        {"lose": {"log": "z-backward.asc", "line": line, "samples": samples}}
        for line, samples in stretches
    ]


def recorded(folder: Path, until: str = "segment", **changes) -> chain.Results:
    """These turns through the chain."""
    return chain.run(chain.simulate(z_turns(**changes), folder / "raw"), folder / "derived", until)


def inputs_of(results: chain.Results, tables: dict[str, pd.DataFrame] | None = None) -> GyroInputs:
    """What the gyros' estimate takes; `tables`: other blocks and performed manoeuvres."""
    changed = {} if tables is None else {key: tables[key] for key in ("blocks", "performed")}
    (data,) = chain.mounts(results, **changed)
    return data.gyro_inputs


def of_z(results_or_tables, key: str = "performed") -> pd.Series:
    """What was performed of the backward turn."""
    return results_or_tables[key].set_index("manoeuvre").loc["z-backward"]
