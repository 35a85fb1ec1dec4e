"""Campaigns of block statistics: drawn by exact physics, solved by the stages."""

import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pandas as pd
import study_plans as plans
from block_statistics import Layout, pieces
from cramer_rao import bound, densities
from ruamel.yaml import YAML

from inertial import tables
from inertial.campaign.noise_levels import effective_levels
from inertial.estimation.triad import linear_names
from stages.accelerometer.stage import STAGE as ACCELEROMETER
from stages.gyroscope.stage import STAGE as GYROSCOPE

NAMES = [f"{s}/{n}" for s in ("accelerometer", "gyroscope") for n in linear_names()]
RATE = 100.0  # samples per second
CLOCKS = pd.DataFrame(
    {
        "log": ["session.asc"],
        "clock": ["GPS"],
        "epoch_gps": [0.0],
        "from_s": [0.0],
        "to_s": [None],
        "interval": [1 / RATE],
    }
)
MISALIGNED, BIAS = 5e-3, (0.01, 1e-5)  # spread of M; of the biases, m/s² and rad/s


@dataclass(frozen=True)
class Planned:
    """A plan as the stage `plan` reads it, and as it is performed."""

    layout: Layout
    manoeuvres: pd.DataFrame
    known: pd.DataFrame


@cache
def planned(plan: str) -> Planned:
    return planned_as(plans.campaign(plan))


def planned_as(document: dict[str, Any]) -> Planned:
    """The same of a campaign file whose log is session.asc."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "campaign"
        folder.mkdir()
        (folder / "session.asc").touch()
        YAML().dump(document, folder / "campaign.yaml")
        results = chain.run(folder, Path(name) / "derived", "plan")
        layout = Layout(pieces(document["plan"]))
        return Planned(layout, results["plan/manoeuvres"], results["plan/known"])


@cache
def least(plan: str, instrument: str) -> np.ndarray:
    """The bound of the 24 parameters, in the order of NAMES."""
    return bound(planned(plan).layout, instrument)


def solved(plan: str, instrument: str, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Errors and stated sigmas of the 24 parameters, NaN where not determined; (24,) each."""
    random = np.random.default_rng([seed, *map(ord, plan + instrument)])
    return solved_as(planned(plan), densities(instrument), random)


def solved_as(
    told: Planned, density: np.ndarray, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """The same of any plan and noise."""
    unknowns = told.layout.truth()
    unknowns[:9] += random.normal(0, MISALIGNED, 9)
    unknowns[12:21] += random.normal(0, MISALIGNED, 9)
    unknowns[9:12], unknowns[21:24] = (random.normal(0, size, 3) for size in BIAS)
    unknowns[24:-3] = random.normal(0, told.layout.known[24:-3])
    unknowns[-3:] = random.normal(0, 0.05, 3)
    seconds = told.layout.seconds
    means = told.layout.read(unknowns)
    means = means + random.normal(0, 1, means.shape) * density / np.sqrt(seconds)[:, None]
    inputs: dict[str, Any] = {
        "blocks": _blocks(told.layout, means),
        "manoeuvres": told.manoeuvres,
        "performed": _performed(told.manoeuvres),
        "levels": effective_levels(_noise(told.manoeuvres, density)),
        "known": told.known,
        "clocks": CLOCKS,
    }
    inputs |= {"averaging_steps": 0, "wanted_bias": 1e-6}
    found = pd.concat([stage.result(inputs)["parameters"] for stage in (ACCELEROMETER, GYROSCOPE)])
    found = found.set_index("id")
    rows = [name.replace("/", "/joint/") for name in NAMES]
    true = np.append(unknowns[:9] - np.eye(3).ravel(), unknowns[9:12])
    true = np.append(true, np.append(unknowns[12:21] - np.eye(3).ravel(), unknowns[21:24]))
    values, sigmas = (found.loc[rows, c].to_numpy(float) for c in ("value", "sigma"))
    return values - true, sigmas


def _blocks(layout: Layout, means: np.ndarray) -> pd.DataFrame:
    names = [p.manoeuvre for p in layout.parts for _ in p.phases]
    phases = [phase for p in layout.parts for phase in p.phases]
    seconds = layout.seconds
    ends = np.cumsum(seconds)
    records = np.round(ends * RATE).astype(np.int64)
    frame = pd.DataFrame(
        {
            "manoeuvre": names,
            "phase": phases,
            "log": "session.asc",
            "from_record": np.append(0, records[:-1]),
            "to_record": records,
            "time": ends - seconds / 2,
            "seconds": seconds,
            "count": seconds * RATE,
            "missing_s": 0.0,
            "table_angle": np.nan,
            "temperature": np.nan,
            "mask_share": 0.0,
        }
    )
    frame[list(tables.CHANNELS)] = means
    return frame


def _performed(manoeuvres: pd.DataFrame) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "manoeuvre": manoeuvres["manoeuvre"],
            "found": True,
            "complete": True,
            "bridged": False,
            "lost": False,
            "angle": manoeuvres["angle"],
            "missing_angle": 0.0,
            "missing_s": 0.0,
            "rate": manoeuvres["rate"],
            "seconds": 0.0,
            "sentence": "as drawn",
        }
    )


def _noise(manoeuvres: pd.DataFrame, density: np.ndarray) -> pd.DataFrame:
    """The noise, known as well as 10⁵ samples tell it."""
    return pd.DataFrame(
        [
            {
                "manoeuvre": name,
                "phase": phase,
                "channel": channel,
                "white_noise": density[i],
                "sigma": 3e-3 * density[i],
                "per_sample": density[i] * RATE**0.5,
                "samples": 100000,
                "data_sheet": None,
            }
            for name in manoeuvres["manoeuvre"]
            for phase in ("rest", "steady")
            for i, channel in enumerate(tables.CHANNELS)
        ]
    )
