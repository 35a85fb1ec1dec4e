"""This calibration into its IMU's archive, against the earlier ones and what others published."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.differences import Difference, table_of
from inertial.campaign.measurement import Measurement, measurements_of
from inertial.campaign.records import Row, rows_of
from inertial.campaign.references import reference_rows, references_of
from inertial.tables.code import hash_of_file
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from inertial.text.parameters import STAGES
from stages.history.archive import Archive, Entry, results
from stages.history.declared import DECLARED
from stages.history.fencepost_error import off_by_a_sample
from stages.history.repeatability import (
    UNKNOWN,
    Series,
    change_rows,
    changes,
    forecast_rows,
    jump_rows,
    jumps_of,
    power_cycle_rows,
    repeatability_rows,
    series_of,
    tolerances,
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


def every_parameter(
    accelerometer_parameters: pd.DataFrame, gyroscope_parameters: pd.DataFrame, result: pd.DataFrame
) -> list[Row]:
    """The parameters by all methods, and those of the result."""
    tables = (accelerometer_parameters, gyroscope_parameters, result)
    return [row for table in tables for row in rows_of(table)]


def reference_shares(
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    uncertainty_budget: pd.DataFrame,
) -> list[Row]:
    """The references of a campaign, and what they add to each sigma."""
    (facts,) = rows_of(campaign)
    references = references_of(facts, rows_of(known), rows_of(manoeuvres))
    return reference_rows(references, rows_of(uncertainty_budget))


def calibration_of(
    campaign: pd.DataFrame,
    inputs: pd.DataFrame,
    parameters: list[Row],
    covariance: pd.DataFrame,
    references: list[Row],
    verdict: pd.DataFrame,
    provenance: Mapping[str, Mapping[str, Any]],
) -> Row:
    """What is archived of a campaign; the parameters by all methods are kept beside the result."""
    (facts,) = rows_of(campaign)
    return facts | {
        "parameters": parameters,
        "covariance": rows_of(covariance),
        "references": references,
        "verdicts": rows_of(verdict),
        "inputs": rows_of(inputs),
        "made_by": _made_by(made for name, made in provenance.items() if name in KEPT),
    }


def published_differences_of(
    published: pd.DataFrame,
    result: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    growing: pd.DataFrame,
    motions: pd.DataFrame,
    level: float,
) -> list[Difference]:
    """The result against what others published, and why it may differ."""
    methods = rows_of(gyroscope_parameters)
    differences: list[Difference] = []
    for mount, counted in measurements_of(result).items():
        own = [row for row in methods if row["mount"] == mount]
        differences += against_published(published, counted, mount, own)
        differences += off_by_a_sample(published, counted.gyro, mount, growing, motions, level)
    return differences


def between_switch_ons_of(
    gyroscope_fit: pd.DataFrame, accelerometer_fit: pd.DataFrame
) -> list[Row]:
    """What biases differ by between the switch-ons of this campaign."""
    return list(power_cycle_rows([*rows_of(gyroscope_fit), *rows_of(accelerometer_fit)]))


def history(
    archive: list[Path],
    calibration: Row,
    published_differences: list[Difference],
    between_switch_ons: list[Row],
    blocks: pd.DataFrame,
    allowed_changes: pd.DataFrame,
    *,
    level: float,
    tolerance: Mapping[str, float] | None = None,
) -> Tables:
    """Archive the result that counts; earlier results of the same IMU; published values.

    Where there are earlier results: how well they repeat, jumps, and what the next may be; and
    when the IMU is due, by `tolerance` where the campaign does not state the allowed changes.

    The archive grows with every campaign. Later additions are read when this stage runs, but
    never cause a rerun.
    """
    kept = Archive(archive[0], simulated=calibration["simulated"])
    entry = kept.add(calibration)
    archived = {
        "file": entry.file,
        "sha256": hash_of_file(kept.root / entry.file),
        "content": entry.row["content"],
        "supersedes": " ".join(entry.row["supersedes"]),
    }
    others = kept.earlier(calibration)
    series = series_of([(each.row, results(each)) for each in [*others, entry]])
    jumps = jumps_of(series, level)
    allowed = tolerances(tolerance or {}, rows_of(allowed_changes))
    return {
        "archived": [archived],
        "earlier": [row for other in others for row in results(other)],
        "published_differences": table_of(published_differences, level),
        "repeatability": [
            *repeatability_rows(series, blocks),
            *between_switch_ons,
        ],
        "changes": list(_changes(series, others, entry, level)),
        "jumps": list(jump_rows(jumps, len(series))),
        "forecast": list(forecast_rows(series, jumps, allowed)) if others else [],
    }


def _changes(series: Series, others: Sequence[Entry], entry: Entry, level: float) -> Iterator[Row]:
    """What changed since the last calibration of a date before this one's."""
    date = entry.row["date"]
    before = [each.row for each in others if UNKNOWN != each.row["date"] < date != UNKNOWN]
    if before:
        last = max(before, key=lambda row: row["date"])
        changed = changes(series, last["campaign"], entry.row["campaign"], level)
        yield from change_rows(changed, last)


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


# ---- The result that counts against what others published of the same IMU

PUBLISHED = "published"
RATE_TABLE = "rate_table"


def against_published(
    published: pd.DataFrame, result: Measurement, mount: str, gyro_methods: Sequence[Row]
) -> Iterator[Difference]:
    """Every published parameter; the sigma is of both, of ours alone where none is published.

    `gyro_methods`: the parameters of the gyros by all methods, on this mount.
    """
    of_table = {r["parameter"]: r["reason"] for r in gyro_methods if r["method"] == RATE_TABLE}
    sensors = {"accel": result.accelerometer, "gyro": result.gyro}
    for row in rows_of(published):
        name, alone = row["quantity"], row["sigma"] is None
        ours = sensors[row["sensor"]].rows.get(name)
        value = None if ours is None else ours["value"]
        reason = ours["reason"] if ours else _("nothing was recorded that shows it")
        if row["sensor"] == "gyro" and of_table.get(name):  # with the rank of what was put in
            reason = of_table[name]
        yield Difference(
            kind=PUBLISHED,
            mount=mount,
            stage=STAGES[row["sensor"]],
            quantity=name,
            unit=row["unit"],
            first=ours["id"] if ours else _("the final result"),
            second=row["source"],
            first_value=value,
            second_value=row["value"],
            sigma=(
                None
                if ours is None or value is None
                else float(np.hypot(ours["sigma"], 0.0 if alone else row["sigma"]))
            ),
            between=(
                _("this calibration"),
                _("the published value ({source})", source=row["source"]),
            ),
            remark=(
                _(
                    "it has no value here, so {source} cannot be judged: {reason}",
                    source=row["source"],
                    reason=reason,
                )
                if value is None
                else _("No sigma is published, so it is ours alone")
                if alone
                else ""
            ),
        )


STAGE = Stage(
    history,
    DECLARED,
    gathers={
        "parameters": every_parameter,
        "references": reference_shares,
        "calibration": calibration_of,
        "published_differences": published_differences_of,
        "between_switch_ons": between_switch_ons_of,
    },
)
