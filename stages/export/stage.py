"""From the tables of a campaign to the texts of the exported files."""

import json
from collections.abc import Mapping
from math import radians
from typing import Any

import pandas as pd

from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Row, manoeuvres_of, rows_of
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage
from stages.export.autopilots import ARDUPILOT, PX4, parameter_file
from stages.export.c_header import c_header
from stages.export.calibration import (
    COMPENSATED,
    Calibration,
    Fits,
    Use,
    epoch_of,
    mounts_of,
    noise_of,
    sample_rate,
    temperature_of,
)
from stages.export.dcc import dcc, stated_by
from stages.export.declared import DECLARED
from stages.export.document import as_json, as_yaml, document
from stages.export.examples import examples_of
from stages.export.noise_yaml import imu_yaml, ros_yaml

FITTED = ("accelerometer", "gyroscope", "extension")  # stages that keep fits


def export(
    provenance: Mapping[str, Mapping[str, Any]],
    samples: Stream,
    *,
    filter_seconds: float,
    rate_rms_deg_s: float,
    force_rms_m_s2: float,
    correlation_seconds: float,
    **tables: pd.DataFrame,
) -> dict[str, str]:
    """Ending of each file's name → its text."""
    use = Use(filter_seconds, radians(rate_rms_deg_s), force_rms_m_s2, correlation_seconds)
    made_by = _made_by(provenance)
    (campaign,) = rows_of(tables["campaign"])
    inputs = rows_of(tables["inputs"])
    if campaign["compensated"]:
        calibration = Calibration(campaign, inputs, use, made_by=made_by, not_exported=COMPENSATED)
    else:
        repairs = Repairs(tables["channel_repairs"])
        plan = manoeuvres_of(tables["manoeuvres"])
        fits, manoeuvres = (
            pd.concat([tables[f"{stage}_{name}"] for stage in FITTED])
            for name in ("fit", "fit_manoeuvres")
        )
        calibration = Calibration(
            campaign,
            inputs,
            use,
            made_by=made_by,
            known=rows_of(tables["known"]),
            noise=noise_of(tables["noise"], tables["terms"]),
            rate=sample_rate(tables["clocks"]),
            epoch_gps=epoch_of(tables["clocks"]),
            temperature=temperature_of(tables["blocks"]),
            mounts=mounts_of(
                plan,
                tables["result"],
                tables["covariance"],
                tables["verdict"],
                Fits(fits, manoeuvres),
                examples_of(plan, tables["blocks"], samples, tables["masks"], repairs),
            ),
        )
    content = document(calibration)
    stated = stated_by(
        tables["certificate"],
        tables["standards"],
        tables["conformity"],
        rows_of(tables["clocks"]),
    )
    return {
        "calibration.json": as_json(content),
        "calibration.yaml": as_yaml(content),
        "calibration.h": c_header(content),
        "dcc.xml": dcc(content, stated),
        "kalibr.yaml": imu_yaml(calibration),
        "ros.yaml": ros_yaml(calibration),
        "px4.params": parameter_file(calibration, PX4),
        "ardupilot.param": parameter_file(calibration, ARDUPILOT),
    }


def _made_by(provenance: Mapping[str, Mapping[str, Any]]) -> list[Row]:
    """Every stage that made one of the tables, and this one: settings, code, what it read."""
    by_stage = {made["stage"]: made for made in provenance.values()}
    own = by_stage.pop("export")
    return [
        {
            "stage": made["stage"],
            "settings": json.dumps(made["settings"], sort_keys=True),
            "code": made["code"],
            "inputs": [
                {"file": file, "sha256": sha} for file, sha in sorted(made["inputs"].items())
            ],
        }
        for made in [*(by_stage[stage] for stage in sorted(by_stage)), own]
    ]


STAGE = Stage(export, DECLARED)
