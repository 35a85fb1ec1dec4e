"""This calibration into the archive of its IMU, and the earlier ones of the same IMU out of it."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from inertial.campaign.final_result import extended_sensors, of_sensors, with_extended
from inertial.campaign.records import Row, rows_of
from inertial.tables.code import hash_of_file
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import EXTENDED, JOINT
from stages.history.archive import Archive, Entry
from stages.history.declared import DECLARED


def history(
    archive: list[Path],
    provenance: Mapping[str, Mapping[str, Any]],
    **tables: pd.DataFrame,
) -> Tables:
    """Archive this calibration; earlier results of the same IMU.

    The archive grows with every campaign. Later additions are read when this stage runs, but
    never cause a rerun. Where the extended result of a sensor is the final one, it is kept beside
    the joint one, with the effects.
    """
    (facts,) = rows_of(tables["campaign"])
    parameters = [
        *rows_of(tables["accelerometer_parameters"]),
        *rows_of(tables["gyroscope_parameters"]),
    ]
    covariance = [
        *rows_of(tables["accelerometer_covariance"]),
        *rows_of(tables["gyroscope_covariance"]),
    ]
    archived_ids = {row["id"] for row in parameters if row["method"] == JOINT}
    final = extended_sensors(rows_of(tables["verdict"]))
    extended = of_sensors(rows_of(tables["extension_parameters"]), final)
    if extended:
        parameters += extended
        extended_ids = {row["id"] for row in extended}
        covariance += [
            row for row in rows_of(tables["extension_covariance"]) if row["first"] in extended_ids
        ]
        archived_ids |= extended_ids
    calibration = facts | {
        "parameters": parameters,
        "covariance": [row for row in covariance if row["first"] in archived_ids],
        "inputs": rows_of(tables["inputs"]),
        "made_by": _made_by(
            made
            for name, made in provenance.items()
            if extended or DECLARED.reads[name].stage not in ("extension", "diagnosis")
        ),
    }
    kept = Archive(archive[0], simulated=facts["simulated"])
    entry = kept.add(calibration)
    archived = {
        "file": entry.file,
        "sha256": hash_of_file(kept.root / entry.file),
        "content": entry.row["content"],
        "supersedes": " ".join(entry.row["supersedes"]),
    }
    earlier = [row for other in kept.earlier(calibration) for row in _final_results(other)]
    return {
        "archived": [archived],
        "earlier": earlier,
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


def _final_results(entry: Entry) -> list[Row]:
    """The final results of an archived calibration, under the names of the joint methods.

    Where the extended result is the final one, the values are its own.
    """
    parameters = list(entry.row["parameters"])
    extended = [row for row in parameters if row["method"] == EXTENDED]
    origin = {"campaign": entry.row["campaign"], "date": entry.row["date"], "file": entry.file}
    return [
        origin
        | {key: row[key] for key in ("id", "mount", "sensor", "value", "sigma", "unit")}
        | {"quantity": row["parameter"]}
        for row in with_extended([row for row in parameters if row["method"] == JOINT], extended)
        if row["value"] is not None
    ]


STAGE = Stage(history, DECLARED)
