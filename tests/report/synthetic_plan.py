"""What the stages plan and decode say of the synthetic campaign."""

from __future__ import annotations

from typing import Any

import numpy as np

from inertial import tables
from stages.plan.stage import ideal_readings
from tests.report.synthetic_values import AXES, DEGREE, GRAVITY, INTERVAL, REST_S, TURN_S, Rows


def about() -> dict[str, Any]:
    return {
        "campaign": "made-up",
        "simulated": True,
        "instrument": "NovAtel SPAN-CPT",
        "serial": "SIM-001",
        "date": "2026-11-02",
        "notes": "Table watched all the time; the computer crashed during z-backward.",
        "table": "three-axis",
        "rate": 100.0,
        "latitude": 30.5278 * DEGREE,
        "height": 24.0,
        "must_be_set": 0x77,
        "compensated": False,
        "must_be_clear": 0,
    }


STATED = {
    "number": "C-17",
    "customer.name": "A customer",
    "issued": "2026-11-03",
    "released_by": "the head of the laboratory",
}


def certificate() -> Rows:
    """A few items stated; the order is the alphabet's."""
    items = ("accreditation", "address", "name", "place")
    names = [f"laboratory.{one}" for one in items]
    names += ["customer.address", "customer.name", "calibrated", "calibrated_by", "issued"]
    names += [f"item.{one}" for one in ("axes", "condition", "firmware", "maker", "part")]
    names += [f"procedure.{one}" for one in ("deviations", "name", "version")]
    names += [f"conditions.{one}" for one in ("humidity", "measured_with", "temperature")]
    names += ["conditions.warm_up", "number", "opinions", "received", "released_by"]
    return [
        {"item": name, "text": STATED.get(name), "unit": "", "required": True, "file": ""}
        for name in [*names, "traceability"]
    ]


def known() -> Rows:
    arc_second = DEGREE / 3600
    return [
        {"quantity": q, "value": value, "sigma": sigma, "unit": unit, "origin": origin}
        | {"assumed": origin.startswith("assumed")}
        for q, value, sigma, unit, origin in (
            ("gravity", GRAVITY, 5e-5, "m/s²", "stated in the campaign file"),
            ("latitude", 30.5278 * DEGREE, 0.01 * DEGREE, "rad", "stated; its sigma is assumed"),
            ("earth_rate_up", 3.7039e-5, 1.1e-8, "rad/s", "computed from the latitude"),
            ("earth_rate_level", 6.2813e-5, None, "rad/s", "computed from the latitude"),
            ("heading", None, None, "rad", "not known"),
            ("position", 0.0, 2 * arc_second, "rad", "stated in the campaign file"),
            ("turn_angle", 0.0, 2 * arc_second, "rad", "stated in the campaign file"),
            ("turn_rate", 0.0, 1e-3, "1", "assumed, for table.rate_sigma_ppm is not stated"),
        )
    ]


def ideal() -> Rows:
    return list(ideal_readings({"latitude_deg": 30.5278, "height_m": 24.0}))


def sensors() -> Rows:
    source = "count: NovAtel, RAWIMU scale factors; noise: NovAtel SPAN-CPT data sheet"
    white = {"accel": 0.0324 / 60, "gyro": 0.0667 * DEGREE / 60}
    return [
        {
            "sensor": sensor,
            "axis": axis,
            "white_noise": noise,
            "source": source,
        }
        for sensor, noise in white.items()
        for axis in tables.AXES
    ]


def manoeuvres() -> Rows:
    rests = [
        _manoeuvre(f"{AXES[i]}-{name}", i, sign, {"do": "rest", "seconds": REST_S})
        for i in range(3)
        for name, sign in (("up", 1.0), ("down", -1.0))
    ]
    turns = [
        _manoeuvre(
            f"{AXES[i]}-{name}",
            i,
            1.0,
            {"do": "turn", "seconds": 38.0, "angle": sign * 2 * np.pi, "angle_sigma": 1e-5}
            | {"rate": sign * 10 * DEGREE, "acceleration": 5 * DEGREE}
            | {f"about_{axis}": 1.0 * (i == j) for j, axis in enumerate(AXES)},
        )
        for i in range(3)
        for name, sign in (("forward", 1.0), ("backward", -1.0))
    ]
    return rests + turns


def _manoeuvre(name: str, axis: int, sign: float, what: dict[str, Any]) -> dict[str, Any]:
    """One whose log is named after it, with an axis up or down."""
    return {
        "manoeuvre": name,
        "position": name,
        "turned_on": 0.0,
        "switch_on": 0,
        "log": f"{name}.asc",
        "mount": "as mounted",
        "recorded": "whole",
        **{f"up_{a}": sign * (axis == j) for j, a in enumerate(AXES)},
        **what,
    }


def seconds_of(row: dict[str, Any]) -> float:
    return REST_S if row["do"] == "rest" else TURN_S


def inputs(manoeuvres: Rows) -> Rows:
    rows: Rows = [{"file": "campaign.yaml", "size": 1326, "sha256": "ab" * 32}]
    for number, row in enumerate(manoeuvres):
        sha256 = f"{number:02x}" * 32
        rows.append(
            {"file": row["log"], "size": round(seconds_of(row) * 8700) + 900, "sha256": sha256}
        )
    return rows


def accounts(manoeuvres: Rows) -> Rows:
    rows: Rows = []
    for row in manoeuvres:
        lines = round(seconds_of(row) / INTERVAL)
        size = round(seconds_of(row) * 8700)
        rows += [
            {
                "log": row["log"],
                "kind": "decoded",
                "name": "RAWIMUSA",
                "lines": lines,
                "bytes": size,
            },
            {
                "log": row["log"],
                "kind": "other message",
                "name": "BESTPOSA",
                "lines": 5,
                "bytes": 900,
            },
        ]
    rows[-1]["bytes"] = 813
    rows.append({"log": "z-backward.asc", "kind": "refused", "name": "", "lines": 1, "bytes": 87})
    return rows


def refused() -> Rows:
    return [
        {
            "log": "z-backward.asc",
            "line": 2194,
            "offset": 190813,
            "bytes": 87,
            "reason": "checksum 3928684b, expected b6a6925a",
            "text": "%RAWIMUSA,2283,42699.880;2283,42699.879998762,00000077,64188,-64,465",
        }
    ]


def clocks(manoeuvres: Rows) -> Rows:
    return [
        {
            "log": row["log"],
            "clock": "GPS",
            "epoch_gps": 1.4e9,
            "recorded_on": "2026-11-02",
            "from_s": 0.0,
            "to_s": seconds_of(row),
            "records": round(seconds_of(row) / INTERVAL),
            "to_record": round(seconds_of(row) / INTERVAL),
            "interval": INTERVAL,
        }
        for row in manoeuvres
    ]
