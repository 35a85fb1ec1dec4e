"""What the first stages found of a recording: faults, manoeuvres, refused lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from inertial import tables
from inertial.campaign.records import Performed, Row, performed_of, rows_of

STAGES = ("quality", "segment")


@dataclass(frozen=True)
class Recording:
    """Findings, the worst first; what was performed of each manoeuvre; refused lines by log."""

    findings: Sequence[Row]
    performed: Sequence[Performed]
    refused: dict[str, int]


def recording(derived: Path) -> Recording:
    """What stands in the tables of a campaign.

    Raises
    ------
    Refusal
        where one of them is missing, damaged, or of another version
    """
    findings = [
        row
        for stage in STAGES
        for row in rows_of(tables.FINDINGS.read(derived / stage / "findings.parquet"))
    ]
    performed = performed_of(tables.PERFORMED.read(derived / "segment/performed.parquet"))
    refused = {
        row["log"]: row["lines"]
        for row in rows_of(tables.ACCOUNTS.read(derived / "decode/accounts.parquet"))
        if row["kind"] == "refused"
    }
    return Recording(sorted(findings, key=_worst_first), list(performed.values()), refused)


def _worst_first(row: Row) -> tuple[int, float, int, str]:
    """By severity, then the least likely by chance, then by count; as the report has them."""
    chance = 1.0 if row["p_value"] is None else row["p_value"]
    return -row["severity"], chance, -row["count"], row["id"]
