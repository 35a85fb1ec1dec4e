"""The synthetic campaign with faults of many kinds, each with the samples around it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from tests.report.synthetic import brief
from tests.report.synthetic_diagnosis import diagnosed
from tests.report.synthetic_recording import close_up
from tests.report.synthetic_values import INTERVAL, rows_as

Frame = pd.DataFrame
FIRST, COUNT = 1900, 400  # the records of a close-up


@dataclass(frozen=True)
class Fault:
    """A fault of one log: which records it concerns, and what it does to the samples."""

    cause: str
    manoeuvre: str
    severity: int
    channel: str = ""
    inside: tuple[int, int] = (1960, 1961)
    shown: tuple[int, int] = (1900, 2021)
    masks: bool = False
    does: Callable[[Frame, Any], None] = lambda frame, inside: None
    more: dict[str, Any] | None = None

    @property
    def identifier(self) -> str:
        """As quality would name it."""
        return "/".join(
            filter(None, ("quality", self.cause, f"{self.manoeuvre}.asc", self.channel))
        )


def add(channel: str, value: float) -> Callable[[Frame, Any], None]:
    """Readings that are off by `value` where the fault is."""

    def does(frame: Frame, inside: Any) -> None:
        frame.loc[inside, channel] += value

    return does


def hold(channel: str, value: float) -> Callable[[Frame, Any], None]:
    """Readings that stand still where the fault is."""

    def does(frame: Frame, inside: Any) -> None:
        frame.loc[inside, channel] = value

    return does


def shift_time(seconds: float) -> Callable[[Frame, Any], None]:
    """Stamps that are off from the fault on."""

    def does(frame: Frame, inside: Any) -> None:
        frame.loc[frame["record"] >= frame.loc[inside, "record"].min(), "time"] += seconds

    return does


def jitter(frame: Frame, inside: Any) -> None:
    """Stamps that come early or late."""
    frame["time"] += 1e-3 * np.sin(frame["record"] * 2.4)


def round_off(frame: Frame, inside: Any) -> None:
    """Readings in coarse steps."""
    frame["accel_y"] = (frame["accel_y"] / 5e-3).round() * 5e-3


LONG = {"shown": (FIRST, FIRST + COUNT), "inside": (FIRST + 60, FIRST + COUNT)}
FAULTS = (
    Fault("spike", "x-up", 1, "accel_x", masks=True, does=add("accel_x", 0.4)),
    Fault("saturation", "y-forward", 3, "gyro_y", (1960, 1985), does=hold("gyro_y", 0.19)),
    Fault("dead_axis", "z-up", 3, "gyro_y", **LONG, does=hold("gyro_y", 0.0)),
    Fault("quantisation", "y-up", 2, "accel_y", **LONG, does=round_off),
    Fault("bias_jump", "z-down", 2, "gyro_x", **LONG, does=add("gyro_x", 4e-4)),
    Fault("status_invalid", "y-down", 2, "", (1960, 1972), masks=True),
    Fault("duplicate", "x-down", 1, "", masks=True, does=shift_time(-INTERVAL)),
    Fault("time_backwards", "x-backward", 3, does=shift_time(-0.7)),
    Fault("clock_jitter", "y-up", 1, **LONG, does=jitter),
    Fault("table_moving", "z-up", 2, "gyro_z", (1960, 2010), does=add("gyro_z", 2e-3)),
)
OF_THE_LOG: tuple[dict[str, Any], ...] = (
    {"cause": "gravity_error", "sensor": "accel", "size": 0.0130, "unit": "m/s²", "severity": 2},
    {"cause": "wrong_day", "size": 10.0, "unit": "days", "severity": 1},
    {"cause": "rate_off", "log": "x-up.asc", "size": 0.5, "unit": "1", "severity": 3},
    {"cause": "wrong_scale_factor", "sensor": "accel", "size": 0.10197, "unit": "1", "severity": 3},
    {"cause": "sign_flip", "sensor": "gyro", "log": "z-forward.asc", "unit": "", "severity": 3},
    {"cause": "axis_swap", "sensor": "accel", "log": "y-up.asc", "unit": "", "severity": 3},
)


def faulty() -> dict[str, Any]:
    """What the report takes, by name; the raw data of the logs that have a fault."""
    generator = np.random.default_rng(7)
    made = brief(*{f"{fault.manoeuvre}.asc" for fault in FAULTS}, *LOGS)
    found = [_finding(fault) for fault in FAULTS]
    found += [
        {
            "id": f"quality/{row['cause']}",
            "count": 1,
            **WORDS,
            **row,
            "sentence": _said(row["cause"]),
        }
        for row in OF_THE_LOG
    ]
    gravity = {"id": "gravity", "repair": "gravity", "state": "applied", "unit": "m/s²"}
    gravity |= {"condition": "gravity is that of the formula", "sentence": "It is used."}
    made["plan_repairs"] = rows_as(tables.REPAIRS, [gravity])
    made["quality_findings"] = pd.concat(
        [made["quality_findings"], rows_as(tables.FINDINGS, found)], ignore_index=True
    )
    shown = [_close_up(fault, generator) for fault in FAULTS]
    made["quality_close_ups"] = pd.concat([made["quality_close_ups"], *shown])
    made["masks"] = rows_as(tables.MASKS, [_mask(fault) for fault in FAULTS if fault.masks])
    return made | diagnosed(made)


LOGS = ("x-forward.asc", "z-forward.asc", "z-backward.asc")  # those of further findings
WORDS = {
    "consequence": "It costs the scale factor of this axis 300 ppm.",
    "action": "Its samples are not used. Look at the plug of the cable.",
}


def _said(cause: str) -> str:
    return f"There is a fault here: {cause.replace('_', ' ')}."


def _finding(fault: Fault) -> dict[str, Any]:
    sensor, _, axis = fault.channel.partition("_")
    first, after = fault.inside
    return {
        "id": fault.identifier,
        "cause": fault.cause,
        "sensor": sensor or None,
        "axis": axis or None,
        "log": f"{fault.manoeuvre}.asc",
        "from_s": first * INTERVAL,
        "to_s": (after - 1) * INTERVAL,
        "count": 1,
        "size": 1.0,
        "unit": "records",
        "severity": fault.severity,
        **WORDS,
        "sentence": _said(fault.cause),
    }


def _close_up(fault: Fault, generator: np.random.Generator) -> Frame:
    record = np.arange(*fault.shown)
    inside = (record >= fault.inside[0]) & (record < fault.inside[1])
    frame = close_up(
        fault.identifier,
        fault.manoeuvre,
        record,
        record * INTERVAL,
        generator,
        concerned=inside,
    )
    fault.does(frame, inside)
    return frame


def _mask(fault: Fault) -> dict[str, Any]:
    return {
        "log": f"{fault.manoeuvre}.asc",
        "from_record": fault.inside[0],
        "to_record": fault.inside[1],
        "sensor": fault.channel[:-2] or None,
        "axis": fault.channel[-1:] or None,
        "repeated": fault.cause == "duplicate",
        "censored": fault.cause == "saturation",
        "finding": fault.identifier,
    }
