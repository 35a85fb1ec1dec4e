"""What made this report, down to the hash of every input."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import pandas as pd

from inertial.text import numbers
from stages.reporting.outline import Column, Row, Section, Table
from stages.reporting.rows import records


def section(inputs: pd.DataFrame, made_by: Mapping[str, Mapping[str, Any]]) -> Section:
    """The inputs with their SHA-256; the stages with settings and code."""
    stages: dict[str, tuple[Mapping[str, Any], list[str]]] = {}
    for table, maker in made_by.items():
        stages.setdefault(str(maker.get("stage", "unknown")), (maker, []))[1].append(table)
    return Section(
        "provenance",
        "Provenance",
        "The inputs, and per stage its settings and the hash of its code.",
        "The same inputs, settings and code give this report again, byte for byte. A hash is "
        "SHA-256; that of a stage covers every module it uses and the lock file of the libraries.",
        (
            Table(
                "Inputs.",
                (Column("File"), Column("Bytes", "number"), Column("SHA-256", "code")),
                tuple(
                    Row(
                        (
                            numbers.shortened(row["file"], 60),
                            numbers.whole(row["size"]),
                            row["sha256"],
                        )
                    )
                    for row in records(inputs)
                ),
            ),
            Table(
                "Stages.",
                (
                    Column("Stage", "name"),
                    Column("Tables in this report"),
                    Column("Settings"),
                    Column("SHA-256 of its code", "code"),
                ),
                tuple(
                    Row(
                        (
                            stage,
                            ", ".join(table.replace("_", " ") for table in tables),
                            _settings(maker.get("settings")),
                            str(maker.get("code", "unknown")),
                        )
                    )
                    for stage, (maker, tables) in stages.items()
                ),
            ),
        ),
    )


def _settings(settings: object) -> str:
    if not isinstance(settings, Mapping) or not settings:
        return "none"
    told = "; ".join(f"{name}: {json.dumps(value)}" for name, value in settings.items())
    return numbers.shortened(told, 400)
