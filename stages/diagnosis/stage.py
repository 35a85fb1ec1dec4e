"""Causes, the one result that counts, and the verdict per sensor; it fits nothing."""

import pandas as pd

from inertial.campaign.records import rows_of
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import EXTENDED, STAGES
from stages.diagnosis.declared import DECLARED


def diagnosis(
    extension_result: pd.DataFrame,
    extension_parameters: pd.DataFrame,
    accelerometer_covariance: pd.DataFrame,
    gyroscope_covariance: pd.DataFrame,
    extension_covariance: pd.DataFrame,
    decision: pd.DataFrame,
) -> Tables:
    """Causes, consequences, members of classes, the result with its covariance, the verdict."""
    extended = {(r["mount"], r["sensor"]) for r in rows_of(decision) if r["result"] == EXTENDED}
    rows = [
        row
        for row in (*rows_of(extension_result), *rows_of(extension_parameters))
        if row["effect"] is None
        and (row["stage"] != "extension" or (row["mount"], row["sensor"]) in extended)
    ]
    rows = list({row["id"]: row for row in rows}.values())
    rows += [
        row
        for row in rows_of(extension_parameters)
        if row["effect"] is not None and (row["mount"], row["sensor"]) in extended
    ]
    ids = {
        row["id"]: f"diagnosis/{STAGES[row['sensor']]}/{row['mount']}/{row['parameter']}"
        for row in rows
    }
    covariances = pd.concat([accelerometer_covariance, gyroscope_covariance, extension_covariance])
    kept = covariances[covariances["first"].isin(list(ids)) & covariances["second"].isin(list(ids))]
    return {
        "causes": [],
        "members": [],
        "consequences": [],
        "result": [{**row, "id": ids[row["id"]], "stage": "diagnosis"} for row in rows],
        "covariance": kept.assign(first=kept["first"].map(ids), second=kept["second"].map(ids)),
        "verdict": [
            {
                "mount": row["mount"],
                "sensor": row["sensor"],
                "verdict": "usable",
                "sentence": "",
                "method": row["result"],
                "condition": None,
                "reason": row["sentence"],
            }
            for row in rows_of(decision)
        ],
    }


STAGE = Stage(diagnosis, DECLARED)
