"""The stages of this project on a campaign: parameters, findings, and time."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import chain  # of the tests: the stages one after another in this process
import numpy as np

import laboratory
from benchmarks.parameters import NAMES, SENSORS
from benchmarks.timing import Seconds, timed
from inertial.arrays import Array

SEVERITY = {3: "invalidates a result", 2: "weakens it", 1: "information"}


@dataclass(frozen=True)
class Solved:
    """The results of the stages on a campaign.

    `values`, `sigmas`: by sensor and method, (12,), NaN where not determined, M and not its errors.
    `seconds`: from the logs to the last of the stages that ran; `says`: see `warnings_of`.
    """

    results: chain.Results
    values: dict[tuple[str, str], Array]
    sigmas: dict[tuple[str, str], Array]
    seconds: Seconds
    says: list[str]

    def covariance(self, stage: str) -> Array:
        """The covariance of the joint fit of a sensor, (12, 12)."""
        table = self.results[f"{stage}/covariance"]
        ids = [f"{stage}/joint/{name}" for name in NAMES]
        square = table.pivot(index="first", columns="second", values="covariance")
        return square.loc[ids, ids].to_numpy(np.float64)


def solve(recording: laboratory.Recording, folder: Path, until: str = "gyroscope") -> Solved:
    """Write a recording and run the chain on it, up to and with a stage."""
    laboratory.write(recording, folder / "raw" / "bench")
    raw, derived = folder / "raw" / "bench", folder / "derived" / "bench"
    seconds = timed(lambda: chain.run(raw, derived, until), 1)
    results = chain.Results(derived)
    values, sigmas = {}, {}
    for stage, method in (
        *((stage, "joint") for stage in SENSORS),
        ("accelerometer", "six_position"),
        ("gyroscope", "turns"),
    ):
        table = results.parameters(stage, method).reindex(NAMES)
        unit = np.append(np.eye(3).ravel(), np.zeros(3))
        values[stage, method] = table["value"].to_numpy(np.float64) + unit
        sigmas[stage, method] = table["sigma"].to_numpy(np.float64)
    return Solved(results, values, sigmas, seconds, warnings_of(results))


def warnings_of(results: chain.Results) -> list[str]:
    """The findings of the stages that ran: each cause, severity, and number."""
    counted: dict[str, int] = {}
    for stage in ("quality", "segment", "criticism"):
        if (results.folder / stage / "findings.parquet").exists():
            table = results[f"{stage}/findings"]
            for cause, severity in zip(table["cause"], table["severity"], strict=True):
                words = f"{cause} ({SEVERITY[severity]})"
                counted[words] = counted.get(words, 0) + 1
    warnings = [words if times == 1 else f"{words} ×{times}" for words, times in counted.items()]
    for stage in SENSORS:
        fit = results[f"{stage}/fit"].iloc[0]
        if fit["scatter"] > 0:
            warnings.append(f"{stage}: the manoeuvres differ by more than noise, sigmas grow")
        parameters = results[f"{stage}/parameters"]
        for method, rows in parameters[parameters["reason"] != ""].groupby("method"):
            warnings.append(f"{stage}/{method} refuses {', '.join(rows['parameter'])}")
    return warnings


def tables_for(derived: Path, stage: str) -> dict[str, Any]:
    """The tables that a stage reads, by argument, from the folder of derived tables."""
    own = chain.stage_of(stage)
    return own.inputs(own.paths(derived))


def run_again(stage: str, inputs: Mapping[str, Any], **changed: Any) -> Any:
    """A stage on tables in memory, nothing read or written; `changed`: settings."""
    settings = {**chain.SETTINGS.get(stage, {}), **changed}
    return chain.stage_of(stage).result({**inputs, **settings})
