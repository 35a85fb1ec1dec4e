"""What quality, segmentation and noise say of the synthetic campaign."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd

from inertial import tables
from tests.report import synthetic_plan as plan
from tests.report.synthetic_values import (
    AXES,
    BIAS,
    DEGREE,
    GAP,
    GAP_FINDING,
    GAP_LINE,
    GRAVITY,
    INTERVAL,
    NOISE,
    REST_S,
    RINGING_FINDING,
    TURN_S,
    Rows,
)


def quality_findings() -> Rows:
    return [
        {
            "id": GAP_FINDING,
            "cause": "gap",
            "severity": 1,
            "log": "z-backward.asc",
            "from_s": GAP[0],
            "to_s": GAP[1],
            "count": 1,
            "size": 1197.0,
            "unit": "samples",
            "consequence": "The turn is not whole: a sum over it lacks 119.8°.",
            "action": "The manoeuvre is left out where its whole angle is used. Record it again.",
            "sentence": "Between lines 2192 and 2193 of z-backward.asc 11.98 s are missing.",
        },
        {
            "id": RINGING_FINDING,
            "cause": "oscillation",
            "severity": 1,
            "sensor": "gyro",
            "axis": "x",
            "log": "x-forward.asc",
            "from_s": 12.0,
            "to_s": 46.0,
            "count": 2,
            "size": 0.01,
            "unit": "rad/s",
            "p_value": 3.2e-45,
            "consequence": "None on whole turns: it averages out in the integral.",
            "action": "Kept. Check the table's drive about x.",
            "sentence": "The x gyro oscillates at 20.0 Hz with 0.010 rad/s while the table turns.",
        },
    ]


def segment_findings() -> Rows:
    return [
        {
            "id": "segment/incomplete/z-backward",
            "cause": "incomplete_turn",
            "severity": 2,
            "manoeuvre": "z-backward",
            "log": "z-backward.asc",
            "count": 1,
            "size": 119.8 * DEGREE,
            "unit": "rad",
            "consequence": "z-backward does not fix the scale of the z gyro.",
            "action": "Left out. Record z-backward again.",
            "sentence": "Of z-backward 240.2° of 360° were recorded.",
        }
    ]


def gap() -> dict[str, Any]:
    missing = round((GAP[1] - GAP[0]) / INTERVAL) - 1
    stretch = {"from_s": GAP[0], "to_s": GAP[1], "missing": missing}
    return {"log": "z-backward.asc", "record": GAP_LINE, **stretch}


def gap_close_up(generator: np.random.Generator) -> pd.DataFrame:
    """Sixty records on both sides of the gap, as S0 shows its lines 2192 and 2193."""
    places = np.arange(-60, 60)
    time = np.where(places < 0, GAP[0] + (places + 1) * INTERVAL, GAP[1] + places * INTERVAL)
    record = GAP_LINE + places
    return close_up(GAP_FINDING, "z-backward", record, time, generator, concerned=places == 99)


def ringing(generator: np.random.Generator) -> pd.DataFrame:
    """The steady part of a turn about x from its beginning on."""
    record = 1140 + np.arange(400)
    time = record * INTERVAL
    frame = close_up(RINGING_FINDING, "x-forward", record, time, generator, concerned=time >= 12)
    frame["gyro_x"] += 0.01 * np.sin(2 * np.pi * 20 * time + 0.3) * (time >= 12)
    return frame


def close_up(
    finding: str,
    manoeuvre: str,
    record: npt.NDArray[np.int64],
    time: npt.NDArray[np.float64],
    generator: np.random.Generator,
    *,
    concerned: npt.NDArray[np.bool_],
) -> pd.DataFrame:
    """Records of a manoeuvre as its log has them, some of which a finding is about."""
    [row] = [row for row in plan.manoeuvres() if row["manoeuvre"] == manoeuvre]
    columns: dict[str, Any] = {
        "finding": finding,
        "log": row["log"],
        "record": record,
        "line": record + 1,
        "time": time,
        "concerned": concerned,
    }
    for i, axis in enumerate(AXES):
        force = GRAVITY * row[f"up_{axis}"] + BIAS["accel"][i]
        rate = rate_of(row, time) * (row.get(f"about_{axis}") or 0.0) + BIAS["gyro"][i]
        for name, value in (("accel", force), ("gyro", rate)):
            columns[f"{name}_{axis}"] = value + NOISE[name] * generator.standard_normal(len(time))
    return pd.DataFrame(tables.CLOSE_UPS.arrow(pd.DataFrame(columns)).to_pandas())


def _phases(row: dict[str, Any]) -> list[tuple[str, float, float]]:
    if row["do"] == "rest":
        return [("rest", 0.0, REST_S)]
    return [
        ("rest", 0.0, 9.9),
        ("spin-up", 10.0, 12.0),
        ("steady", 12.0, 46.0),
        ("spin-down", 46.0, 48.0),
        ("rest", 48.1, TURN_S),
    ]


def segments(manoeuvres: Rows) -> Rows:
    return [
        {
            "manoeuvre": row["manoeuvre"],
            "phase": phase,
            "log": row["log"],
            "from_record": round(start / INTERVAL),
            "to_record": round(end / INTERVAL),
            "from_s": start,
            "to_s": end,
        }
        for row in manoeuvres
        for phase, start, end in _phases(row)
    ]


def performed(manoeuvres: Rows) -> Rows:
    rows: Rows = []
    for row in manoeuvres:
        turn = row["do"] == "turn"
        whole = row["manoeuvre"] != "z-backward"
        missing = 0.0 if whole else -119.81 * DEGREE
        angle = row["angle"] * 1.0000031 - missing if turn else None
        rows.append(
            {
                "manoeuvre": row["manoeuvre"],
                "found": True,
                "complete": whole,
                "bridged": not whole,
                "lost": not whole,
                "angle": angle,
                "missing_angle": missing if turn else None,
                "missing_s": 0.0 if whole else GAP[1] - GAP[0],
                "rate": row["rate"] * 1.00003 if turn else None,
                "seconds": 299.98 if not turn else 38.02,
                "sentence": "recorded as planned"
                if whole
                else "11.98 s and 119.8° of the turn are missing",
            }
        )
    return rows


def rate_of(row: dict[str, Any], time: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    if row["do"] == "rest":
        return np.zeros_like(time)
    ramp = np.clip((time - 10) / 2, 0, 1) - np.clip((time - 46) / 2, 0, 1)
    return np.asarray(ramp * row["rate"])


def trace(row: dict[str, Any], generator: np.random.Generator) -> pd.DataFrame:
    """The envelope of a log: a hundred and some samples a row."""
    per_row = 50 if row["do"] == "rest" else 12
    time = np.arange(0, plan.seconds_of(row), INTERVAL)
    if row["manoeuvre"] == "z-backward":
        time = time[(time <= GAP[0]) | (time >= GAP[1])]
    pieces = time[: len(time) // per_row * per_row].reshape(-1, per_row)
    columns: dict[str, Any] = {
        "log": row["log"],
        "from_record": np.arange(len(pieces)) * per_row,
        "to_record": (np.arange(len(pieces)) + 1) * per_row,
        "from_s": pieces[:, 0],
        "to_s": pieces[:, -1],
    }
    for i, axis in enumerate(AXES):
        force = GRAVITY * row[f"up_{axis}"] + BIAS["accel"][i]
        turn = rate_of(row, pieces) * (row.get(f"about_{axis}") or 0.0) + BIAS["gyro"][i]
        turning = row["do"] == "turn" and axis == "x" and row["about_x"] == 1.0
        turn = turn + 0.01 * turning * np.sin(2 * np.pi * 20 * pieces) * (rate_of(row, pieces) != 0)
        for name, value, noise in (("accel", force, 1.07e-3), ("gyro", turn, 3.5e-5)):
            samples = value + noise * generator.standard_normal(pieces.shape)
            columns[f"least_{name}_{axis}"] = samples.min(axis=1)
            columns[f"most_{name}_{axis}"] = samples.max(axis=1)
    return pd.DataFrame(columns)


def noise(manoeuvres: Rows, generator: np.random.Generator) -> Rows:
    white = {"accel": 1.07e-4, "gyro": 3.49e-6}
    sheet = {f"{row['sensor']}_{row['axis']}": row["white_noise"] for row in plan.sensors()}
    rows: Rows = []
    for row in manoeuvres:
        for channel in tables.CHANNELS:
            value = white[channel[:-2]] * (1 + 0.03 * generator.standard_normal())
            if channel == "accel_y" and row.get("up_x"):
                value *= 5.5
            rows.append(
                {
                    "manoeuvre": row["manoeuvre"],
                    "phase": "rest" if row["do"] == "rest" else "steady",
                    "channel": channel,
                    "white_noise": value,
                    "sigma": value * 0.03,
                    "per_sample": value * 10,
                    "samples": 30000,
                    "data_sheet": sheet[channel],
                }
            )
    return rows
