"""This calibration into its IMU's archive, against the earlier ones and what others published."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from inertial.campaign.differences import Difference, table_of
from inertial.campaign.measurement import measurements_of
from inertial.campaign.records import Row, rows_of
from inertial.tables.code import hash_of_file
from inertial.tables.stage import Stage, Tables
from stages.history.archive import RESULT, Archive, Entry
from stages.history.declared import DECLARED
from stages.history.fencepost_error import off_by_a_sample
from stages.history.published import against_published
from stages.history.repeatability import (
    forecast_rows,
    jump_rows,
    jumps_of,
    repeatability_rows,
    series_of,
)

# The inputs whose content is archived.
KEPT = (
    "campaign",
    "inputs",
    "accelerometer_parameters",
    "gyroscope_parameters",
    "result",
    "covariance",
    "verdict",
)


def history(
    archive: list[Path],
    campaign: pd.DataFrame,
    inputs: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    result: pd.DataFrame,
    covariance: pd.DataFrame,
    verdict: pd.DataFrame,
    published: pd.DataFrame,
    growing: pd.DataFrame,
    motions: pd.DataFrame,
    blocks: pd.DataFrame,
    provenance: Mapping[str, Mapping[str, Any]],
    *,
    level: float,
    tolerance: Mapping[str, float] | None = None,
) -> Tables:
    """Archive the result that counts; earlier results of the same IMU; published values.

    Where there are earlier results: how well they repeat, jumps, and what the next may be.

    The archive grows with every campaign. Later additions are read when this stage runs, but
    never cause a rerun. The parameters by all methods are kept beside the result.
    """
    (facts,) = rows_of(campaign)
    methods = rows_of(gyroscope_parameters)
    calibration = facts | {
        "parameters": [*rows_of(accelerometer_parameters), *methods, *rows_of(result)],
        "covariance": rows_of(covariance),
        "verdicts": rows_of(verdict),
        "inputs": rows_of(inputs),
        "made_by": _made_by(made for name, made in provenance.items() if name in KEPT),
    }
    kept = Archive(archive[0], simulated=facts["simulated"])
    entry = kept.add(calibration)
    archived = {
        "file": entry.file,
        "sha256": hash_of_file(kept.root / entry.file),
        "content": entry.row["content"],
        "supersedes": " ".join(entry.row["supersedes"]),
    }

    def differences() -> Iterator[Difference]:
        for mount, counted in measurements_of(result).items():
            own = [row for row in methods if row["mount"] == mount]
            yield from against_published(published, counted, mount, own)
            yield from off_by_a_sample(published, counted.gyro, mount, growing, motions, level)

    others = kept.earlier(calibration)
    series = series_of([(each.row, _results(each)) for each in [*others, entry]])
    jumps = jumps_of(series, level)
    return {
        "archived": [archived],
        "earlier": [row for other in others for row in _results(other)],
        "published_differences": table_of(list(differences()), level),
        "repeatability": list(repeatability_rows(series, blocks)),
        "jumps": list(jump_rows(jumps, len(series))),
        "forecast": list(forecast_rows(series, jumps, tolerance or {})) if others else [],
    }


def _made_by(provenance: Iterable[Mapping[str, Any]]) -> list[Row]:
    """The stages that made the tables, each once."""
    by_stage = {made["stage"]: made for made in provenance}
    return [
        {
            "stage": stage,
            "settings": json.dumps(made["settings"], sort_keys=True),
            "code": made["code"],
            "inputs": json.dumps(made["inputs"], sort_keys=True),
        }
        for stage, made in sorted(by_stage.items())
    ]


def _results(entry: Entry) -> list[Row]:
    """The parameters of the result that counted in an archived calibration, with its verdict."""
    verdicts = {(row["mount"], row["sensor"]): row for row in _rows(entry, "verdicts")}
    origin = {"campaign": entry.row["campaign"], "date": entry.row["date"], "file": entry.file}
    nothing: Row = {"verdict": None, "condition": None}
    rows = []
    for row in _rows(entry, "parameters"):
        if row["stage"] == RESULT and row["effect"] is None and row["value"] is not None:
            verdict = verdicts.get((row["mount"], row["sensor"]), nothing)
            rows.append(
                origin
                | {key: row[key] for key in ("id", "mount", "sensor", "value", "sigma", "unit")}
                | {"quantity": row["parameter"]}
                | {key: verdict[key] for key in nothing}
            )
    return rows


def _rows(entry: Entry, name: str) -> Sequence[Row]:
    return list(entry.row[name])


STAGE = Stage(history, DECLARED)
