"""This calibration into the archive of its IMU, and the earlier ones of the same IMU out of it."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from inertial import tables
from inertial.campaign.final_result import counting, extended_methods
from inertial.campaign.records import Row, rows_of
from inertial.tables.code import hash_of_file
from inertial.tables.declared import Declared, From
from inertial.tables.stage import Stage, Tables
from stages.archiving.archive import Archive, Entry


def history(
    campaign: pd.DataFrame,
    inputs: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_covariance: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_covariance: pd.DataFrame,
    extension_parameters: pd.DataFrame,
    extension_covariance: pd.DataFrame,
    decision: pd.DataFrame,
    archive: list[Path],
    provenance: Mapping[str, Mapping[str, Any]],
) -> Tables:
    """Which file of the archive holds this calibration, and what was found earlier.

    The archive grows with every campaign. What others add to it is read when this stage runs,
    but never makes it run again. Where the extended result of a sensor counts it is kept beside
    the joint one, with the effects; a calibration that has none in the archive is of the joint one.
    """
    (facts,) = rows_of(campaign)
    parameters = [*rows_of(accelerometer_parameters), *rows_of(gyroscope_parameters)]
    covariance = [*rows_of(accelerometer_covariance), *rows_of(gyroscope_covariance)]
    joint = {row["id"] for row in parameters if _is_joint(row)}
    methods = extended_methods(rows_of(decision))
    extended = [row for row in rows_of(extension_parameters) if row["method"] in methods]
    own = {row["id"] for row in extended}
    parameters += extended
    covariance += [row for row in rows_of(extension_covariance) if row["first"] in own]
    of_extension = {"extension_parameters", "extension_covariance", "decision"}
    used = {name: made for name, made in provenance.items() if extended or name not in of_extension}
    calibration = facts | {
        "parameters": parameters,
        "covariance": [row for row in covariance if row["first"] in joint | own],
        "inputs": rows_of(inputs),
        "made_by": _makers(used),
    }
    kept = Archive(archive[0], simulated=facts["simulated"])
    entry = kept.add(calibration)
    archived = {
        "file": entry.file,
        "sha256": hash_of_file(kept.root / entry.file),
        "content": entry.row["content"],
        "supersedes": " ".join(entry.row["supersedes"]),
    }
    earlier = [row for other in kept.earlier(calibration) for row in _numbers(other)]
    return {
        "archived": pd.DataFrame([archived]),
        "earlier": pd.DataFrame(earlier) if earlier else tables.EARLIER.empty(),
    }


def _makers(provenance: Mapping[str, Mapping[str, Any]]) -> list[Row]:
    """The stages that made the tables, each once."""
    by_stage = {maker["stage"]: maker for maker in provenance.values()}
    return [
        {
            "stage": stage,
            "settings": json.dumps(maker["settings"], sort_keys=True),
            "code": maker["code"],
            "inputs": json.dumps(maker["inputs"], sort_keys=True),
        }
        for stage, maker in sorted(by_stage.items())
    ]


def _numbers(entry: Entry) -> list[Row]:
    """What an archived calibration has determined, by the names of the joint methods.

    Where the extended result counted, the values are its own.
    """
    every = list(entry.row["parameters"])
    where = {"campaign": entry.row["campaign"], "date": entry.row["date"], "file": entry.file}
    return [
        where | {key: row[key] for key in ("id", "value", "sigma", "unit")}
        for row in counting([row for row in every if _is_joint(row)], every)
        if row["value"] is not None
    ]


def _is_joint(row: Row) -> bool:
    """Whether a parameter is of a joint method: `joint`, or `joint@<mount>` for each mount."""
    return str(row["method"]).partition("@")[0] == "joint"


STAGE = Stage(
    history,
    Declared(
        reads={
            "campaign": From("plan", tables.CAMPAIGN),
            "inputs": From("plan", tables.INPUTS),
            "accelerometer_parameters": From("accelerometer", tables.PARAMETERS),
            "accelerometer_covariance": From("accelerometer", tables.COVARIANCE),
            "gyroscope_parameters": From("gyroscope", tables.PARAMETERS),
            "gyroscope_covariance": From("gyroscope", tables.COVARIANCE),
            "extension_parameters": From("extension", tables.PARAMETERS),
            "extension_covariance": From("extension", tables.COVARIANCE),
            "decision": From("extension", tables.DECISION),
        },
        writes={"archived": tables.ARCHIVED, "earlier": tables.EARLIER},
        files=("archive",),
    ),
)

if __name__ == "__main__":
    STAGE.command_line()
