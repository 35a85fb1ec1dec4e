"""The calibration for other programs: JSON and YAML, Kalibr, PX4, ArduPilot.

    python -m stages.export --campaign … --known … --output reports/demo

writes reports/demo.calibration.json, .calibration.yaml, .kalibr.yaml, .px4.params and
.ardupilot.param. It writes texts instead of tables, so it has a command line of its own.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from inertial import tables
from inertial.campaign.final_result import extended_methods
from inertial.campaign.masked_samples import Masks
from inertial.campaign.records import Row, manoeuvres_of, rows_of
from inertial.tables.code import code_of, hash_of, hash_of_file
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Stream, provenance
from inertial.tables.table import Table
from inertial.tables.whole_files import write_whole
from stages.exporting.ardupilot import ardupilot
from stages.exporting.calibration import (
    COMPENSATED,
    Calibration,
    mounts_of,
    noise_of,
    rate_of,
    temperature_of,
)
from stages.exporting.calibration_json import calibration_json
from stages.exporting.document import document
from stages.exporting.kalibr import kalibr
from stages.exporting.px4 import px4
from stages.exporting.worked import worked
from stages.exporting.yaml_text import yaml_text

READS: Mapping[str, Table] = {
    "campaign": tables.CAMPAIGN,
    "known": tables.KNOWN,
    "inputs": tables.INPUTS,
    "manoeuvres": tables.MANOEUVRES,
    "clocks": tables.CLOCKS,
    "samples": tables.SAMPLES,
    "masks": tables.MASKS,
    "blocks": tables.BLOCKS,
    "noise": tables.NOISE,
    "accelerometer_parameters": tables.PARAMETERS,
    "accelerometer_covariance": tables.COVARIANCE,
    "accelerometer_fit": tables.FIT,
    "gyroscope_parameters": tables.PARAMETERS,
    "gyroscope_covariance": tables.COVARIANCE,
    "gyroscope_fit": tables.FIT,
    "extension_parameters": tables.PARAMETERS,
    "extension_covariance": tables.COVARIANCE,
    "extension_fit": tables.FIT,
    "decision": tables.DECISION,
}
STREAMS = ("samples",)  # too long for memory


def export(
    *,
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    inputs: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    clocks: pd.DataFrame,
    samples: Stream,
    masks: pd.DataFrame,
    blocks: pd.DataFrame,
    noise: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_covariance: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_covariance: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    extension_parameters: pd.DataFrame,
    extension_covariance: pd.DataFrame,
    extension_fit: pd.DataFrame,
    decision: pd.DataFrame,
    made_by: Sequence[Row],
) -> dict[str, str]:
    """What the name of each file ends with → its text."""
    (about,) = rows_of(campaign)
    listed, plan = rows_of(inputs), manoeuvres_of(manoeuvres)
    if about["compensated"]:
        nothing: dict[str, Any] = {"known": (), "noise": (), "rate": None, "temperature": None}
        found = Calibration(
            about, listed, **nothing, mounts=(), made_by=made_by, nothing=COMPENSATED
        )
    else:
        found = Calibration(
            about,
            listed,
            rows_of(known),
            noise_of(noise),
            rate_of(clocks),
            temperature_of(blocks),
            mounts_of(
                plan,
                {
                    "accelerometer": (
                        accelerometer_parameters,
                        accelerometer_covariance,
                        accelerometer_fit,
                    ),
                    "gyroscope": (gyroscope_parameters, gyroscope_covariance, gyroscope_fit),
                    "extension": (extension_parameters, extension_covariance, extension_fit),
                },
                extended_methods(rows_of(decision)),
                worked(plan, blocks, samples, Masks(masks)),
            ),
            made_by,
        )
    told = document(found)
    return {
        "calibration.json": calibration_json(told),
        "calibration.yaml": yaml_text(told),
        "kalibr.yaml": kalibr(found),
        "px4.params": px4(found),
        "ardupilot.param": ardupilot(found),
    }


def makers(paths: Mapping[str, Path]) -> list[Row]:
    """Every stage that made one of these tables, and this one: settings, code, what it read."""
    by_stage = {made["stage"]: made for made in map(provenance, paths.values())}
    own = {
        "stage": "export",
        "settings": {},
        "code": hash_of(code_of("export")),
        "inputs": {f"{p.parent.name}/{p.name}": hash_of_file(p) for p in paths.values()},
    }
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


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the tables, write the files beside their place, then move them there."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, table in READS.items():
        parser.add_argument(
            f"--{name}", type=Path, required=True, metavar="PATH", help=f"{table.name} table"
        )
    parser.add_argument(
        "--output", type=Path, required=True, help="folder and beginning of the files' names"
    )
    given = parser.parse_args(arguments)
    paths: dict[str, Path] = {name: getattr(given, name) for name in READS}
    try:
        read: dict[str, Any] = {
            name: table.stream(paths[name]) if name in STREAMS else table.read(paths[name])
            for name, table in READS.items()
        }
        texts = export(**read, made_by=makers(paths))
        beginning = given.output
        write_whole(
            {
                beginning.with_name(f"{beginning.name}.{ending}"): text.encode()
                for ending, text in texts.items()
            }
        )
    except Refusal as refusal:
        sys.exit(f"export: {refusal}")


if __name__ == "__main__":
    main()
