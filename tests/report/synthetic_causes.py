"""What criticism says of the synthetic campaign, row by row: causes, structures, blind spots."""

from __future__ import annotations

from typing import Any

import numpy as np

from inertial import tables
from tests.report.synthetic_values import rows_as

Rows = list[dict[str, Any]]
KINDS = ("time", "angle", "rate", "attitude", "temperature", "change")
NAMED = {"mount": "", "count": 1, "unit": "sigma", "severity": 2, "p_value": 0.0, "sensor": "gyro"}
DEGREE_PER_HOUR = np.pi / 180 / 3600


def findings() -> Rows:
    """An effect that is found, and an oscillation."""
    return [
        NAMED
        | {
            "id": "criticism/gyro_g_sensitivity",
            "cause": "gyro_g_sensitivity",
            "unit": "1",
            "consequence": "The model without it is not the whole truth.",
            "action": "Look at it.",
            "sentence": "The data ask for gyro g sensitivity.",
            "verdict": "found",
            "members": ["gyro_g_sensitivity"],
            "snr": 77.0,
        },
        NAMED
        | {
            "id": "criticism/oscillation",
            "cause": "oscillation",
            "consequence": "It does no harm.",
            "action": "Look at it.",
            "sentence": "The case oscillates about x while the table turns.",
            "verdict": "found",
            "members": ["oscillation"],
            "snr": 60.0,
        },
    ]


def cause_tables(rows: Rows) -> dict[str, Any]:
    """The findings, and the link table of their members, which each lists."""
    members = [
        {"finding": row["id"], "mount": "", "rank": rank, "effect": effect}
        for row in rows
        for rank, effect in enumerate(row.get("members", ()), 1)
    ]
    plain = [{key: row[key] for key in row if key != "members"} for row in rows]
    return {
        "criticism_findings": rows_as(tables.EFFECT_FINDINGS, plain),
        "members": rows_as(tables.MEMBERS, members),
        "cause_positions": tables.CAUSE_POSITIONS.empty(),
    }


def detection_limits() -> Rows:
    """An effect that is detectable on three axes, one that is not, and one that was named."""

    def limit(effect: str, parameter: str, size: float | None, unit: str) -> dict[str, Any]:
        return {
            "mount": "",
            "effect": effect,
            "parameter": parameter,
            "limit": size,
            "smallest": size,
            "largest": size,
            "unit": unit,
            "moves": 3.25 if size else None,
            "moved_sensor": "accel" if size else None,
            "moved_parameter": "bias_z" if size else None,
            "reason": "visible" if size else "not_excited",
            "explanation": None if size else "no manoeuvre excites it.",
            "sentence": f"{effect}, {parameter}",
        }

    sizes = {"x": 1.1e-3, "y": 1.65e-3, "z": 0.9e-3}
    return [
        limit("gyro_g_sensitivity", "g_xx", 6.9e-8, "(rad/s)/(m/s²)"),
        *(limit("lever_arm", f"r_{axis}", size, "m") for axis, size in sizes.items()),
        limit("table_tilt", "north", None, "rad"),
        limit("table_tilt", "east", None, "rad"),
    ]


def structures(*firing: str) -> Rows:
    """The six tests, silent but for the kinds in `firing`; no temperature was recorded."""
    return [
        {
            "mount": "",
            "kind": kind,
            "sensor": "gyro",
            "axis": "x",
            "scan_value": 1200.0 if kind == "change" else None,
            "statistic": 75.0 if kind in firing else 9.0,
            "degrees": 6,
            "p_value": 1e-9 if kind in firing else 0.09 + 0.1 * KINDS.index(kind),
            "detected": kind in firing,
        }
        if kind != "temperature"
        else {"mount": "", "kind": kind, "detected": False}
        for kind in KINDS
    ]


def points(*kinds: str) -> Rows:
    """What is left of the x gyro: 2 °/h from 20 minutes, or beyond half a turn."""
    units = {"time": ("s", 2400.0), "change": ("s", 2400.0), "angle": ("rad", 2 * np.pi)}
    return [
        {
            "mount": "",
            "kind": kind,
            "sensor": "gyro",
            "axis": "x",
            "x": share * units[kind][1],
            "x_unit": units[kind][0],
            "residual": 2 * DEGREE_PER_HOUR * (share > 0.5),
            "sigma": 0.3 * DEGREE_PER_HOUR,
            "structure": 1.9 * DEGREE_PER_HOUR * (share > 0.5),
            "unit": "rad/s",
        }
        for kind in kinds
        for share in np.linspace(0, 1, 40).tolist()
    ]
