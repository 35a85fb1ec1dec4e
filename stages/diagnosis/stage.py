"""Causes, the one result that counts, and the verdict per sensor; it fits nothing."""

import pandas as pd

from inertial.campaign.records import Row, rows_of
from inertial.estimation.triad import linear_names
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import JOINT
from stages.diagnosis.decision import Decision, alarms_of, decided
from stages.diagnosis.declared import DECLARED
from stages.diagnosis.result import Result, covariance_by_ids, result_of


def diagnosis(
    criticism_findings: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_covariance: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_covariance: pd.DataFrame,
    extension_parameters: pd.DataFrame,
    extension_covariance: pd.DataFrame,
    candidates: pd.DataFrame,
    candidate_effects: pd.DataFrame,
) -> Tables:
    """Causes, consequences, members of classes, the result with its covariance, the verdict."""
    findings = rows_of(criticism_findings)
    joint = [*rows_of(accelerometer_parameters), *rows_of(gyroscope_parameters)]
    joint = [r for r in joint if r["method"] == JOINT and r["parameter"] in linear_names()]
    parameters = [*joint, *rows_of(extension_parameters)]
    covariance = covariance_by_ids(
        accelerometer_covariance, gyroscope_covariance, extension_covariance
    )
    results: list[Result] = []
    verdicts: list[Row] = []
    for mount, sensor in dict.fromkeys((r["mount"], r["sensor"]) for r in rows_of(candidates)):
        own, effects, values = (
            [row for row in rows if (row["mount"], row["sensor"]) == (mount, sensor)]
            for rows in (rows_of(candidates), rows_of(candidate_effects), parameters)
        )
        decision = decided(
            own,
            effects,
            alarms_of(findings, mount, sensor),
            determined=any(r["value"] is not None for r in values if r["method"] == JOINT),
        )
        by_method = {r["method"]: [v for v in values if v["method"] == r["method"]] for r in own}
        result = result_of(decision.method, by_method, covariance, _competing(own, decision))
        results.append(result)
        verdicts.append(
            {
                "mount": mount,
                "sensor": sensor,
                "verdict": "usable",
                "sentence": "",
                "method": result.method,
                "condition": None,
                "reason": decision.reason,
            }
        )
    tables = [result.covariance_rows() for result in results]
    return {
        "causes": [],
        "members": [],
        "consequences": [],
        "result": [row for result in results for row in result.rows],
        "covariance": pd.concat(tables) if tables else DECLARED.writes["covariance"].empty(),
        "verdict": verdicts,
    }


def _competing(candidates: list[Row], decision: Decision) -> dict[str, float]:
    """The probabilities of the members of a class by method; of the joint result nothing else."""
    if decision.method == JOINT:
        return {}
    return {row["method"]: row["probability"] for row in candidates if row["probability"] > 0}


STAGE = Stage(diagnosis, DECLARED)
