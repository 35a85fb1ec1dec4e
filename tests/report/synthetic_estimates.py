"""What the synthetic campaign gives, beside other results and earlier ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from tests.report.synthetic_values import (
    AXES,
    BIAS,
    CROSS,
    GRAVITY,
    PAIRS,
    REST_S,
    SCALE,
    SENSOR,
    Rows,
)


def parameters(stage: str, method: str) -> Rows:
    sensor = {"accelerometer": "accel", "gyroscope": "gyro"}[stage]
    unit = tables.UNITS[sensor]
    sigma = {"bias": {"accel": 1.1e-5, "gyro": 2.1e-8}[sensor], "scale": 2.2e-6, "cross": 4.1e-6}
    joint = method == "joint"
    entries: list[tuple[str, float | None, str, str]] = []
    for i, axis in enumerate(AXES):
        entries.append(
            (f"bias_{axis}", BIAS[sensor][i], unit, f"reading at no input, {axis} sensor")
        )
    for i, axis in enumerate(AXES):
        entries.append(
            (f"scale_{axis}", SCALE[sensor][i], "1", f"scale error of the {axis} sensor")
        )
    for (i, j), value in zip(PAIRS, CROSS, strict=True):
        given = value if joint or sensor == "accel" else None
        name = f"cross_{AXES[i]}{AXES[j]}"
        entries.append((name, given, "1", f"the {AXES[i]} sensor's response to {AXES[j]} input"))
    if joint:
        for axis, value in zip(AXES, (0.00074, 0.00758, -0.00246), strict=True):
            entries.append(
                (f"mounting_{axis}", value, "rad", f"rotation of the triad about {axis}")
            )
        for pair, value in zip(("xy", "xz", "yz"), (-280.6e-6, 24.8e-6, -41.2e-6), strict=True):
            entries.append((f"symmetric_{pair}", value, "rad", f"{pair} out of square"))
    return [
        {
            "id": f"{stage}/{method}/{name}",
            "stage": stage,
            "sensor": SENSOR[stage],
            "method": method,
            "parameter": name,
            "value": value,
            "sigma": None if value is None else sigma.get(name.partition("_")[0], 5e-6),
            "unit": unit_of,
            "frame": "body",
            "meaning": meaning,
            "reason": ""
            if value is not None
            else "the turns fix only the axis that turns; rests in six positions would help",
        }
        for name, value, unit_of, meaning in entries
    ]


def fit(stage: str, other: str) -> Rows:
    p_value = 2.4e-9 if stage == "gyroscope" else 0.41
    chi_squared = 812.4 if stage == "gyroscope" else 603.1
    noise = {"scatter": 0.0, "random_walk": 0.0, "random_walk_sigma": 0.0, "switch_ons": 1}
    noise |= {"scatter_seconds": None}
    noise |= {"unit": tables.UNITS["accel" if stage == "accelerometer" else "gyro"]}
    row = {"chi_squared": chi_squared, "degrees": 594, "p_value": p_value}
    plain = {"chi_squared": 5.1, "degrees": 6, "p_value": 0.53}
    return [
        {"sensor": SENSOR[stage], "method": "joint", **row, **noise},
        {"sensor": SENSOR[stage], "method": other, **plain, **noise},
    ]


def fit_manoeuvres(stage: str, other: str) -> Rows:
    rests = ["x-up", "x-down", "y-up", "y-down", "z-up", "z-down"]
    used = {"joint": [*rests, "x-forward", "x-backward", "y-forward"], other: rests[:3]}
    left_out = {"z-backward": "119.8° of 360° are missing"} if stage == "gyroscope" else {}
    return [
        {"sensor": SENSOR[stage], "method": method, "manoeuvre": name}
        | {"used": name not in left_out, "reason": left_out.get(name)}
        for method, names in used.items()
        for name in (*names, *left_out)
    ]


def averaging(parameters: Rows, generator: np.random.Generator) -> Rows:
    rows: Rows = []
    for parameter in parameters:
        if parameter["method"] != "joint" or parameter["value"] is None:
            continue
        if parameter["parameter"].partition("_")[0] not in ("bias", "scale", "cross"):
            continue
        for seconds in np.geomspace(5, REST_S, 20):
            sigma = parameter["sigma"] * float(np.sqrt(REST_S / seconds))
            spread = np.sqrt(max(sigma**2 - parameter["sigma"] ** 2, 0.0))
            value = parameter["value"] + spread * generator.standard_normal() * 0.8
            rows.append(
                {key: parameter[key] for key in ("sensor", "method")}
                | {"quantity": parameter["parameter"], "seconds": seconds}
                | {"value": value, "sigma": sigma}
            )
    return rows


def wanted(stage: str, method: str) -> Rows:
    sigma, floor = (9e-5, 3e-5) if stage == "accelerometer" else (7e-7, 0.0)
    row = {"seconds": REST_S, "sigma": sigma, "floor": floor, "random_walk": sigma * REST_S**0.5}
    times = {"x": (2 * sigma, 60.0), "y": (sigma / 2, 1200.0), "z": (floor / 2, None)}
    return [
        {"sensor": SENSOR[stage], "method": method, "quantity": f"bias_{axis}"}
        | {"wanted": wanted, "wanted_seconds": time}
        | row
        for axis, (wanted, time) in times.items()
    ]


def differences() -> Rows:
    def row(kind: str, quantity: str, unit: str, sigmas: float | None, said: str) -> dict[str, Any]:
        one = {
            "id": f"comparison/{kind}/gyroscope/{quantity}",
            "kind": kind,
            "sensor": "gyro",
            "quantity": quantity,
            "unit": unit,
            "first": f"gyroscope/turn_and_stop/{quantity}",
            "second": f"gyroscope/joint/{quantity}",
            "first_value": 2e-6,
            "second_value": 1e-6,
            "sentence": said,
        }
        if sigmas is None:
            return one
        sigma = abs(1e-6 / sigmas)
        p_value = 1e-9 if abs(sigmas) > 5 else 0.4
        difference = {"difference": np.sign(sigmas) * 1e-6, "sigma": sigma}
        return (
            one
            | difference
            | {"in_sigmas": sigmas, "p_value": p_value, "significant": p_value < 0.01}
        )

    return [
        row("method_against_method", "bias_y", "rad/s", 0.9, "bias: they agree."),
        row(
            "method_against_method",
            "scale_x",
            "1",
            None,
            "scale factor of the x gyro: not independent.",
        ),
        row(
            "static_against_turns",
            "bias_x",
            "rad/s",
            -13.2,
            "bias of the x gyro: rests and turns differ by 0.2 °/h: more than chance.",
        ),
    ]


def published() -> Rows:
    (row, *_others) = differences()
    told = {"id": "comparison/published/gyroscope/bias_y", "kind": "published"}
    return [row | told | {"sentence": "bias: this one and the published value agree."}]


def checks(manoeuvres: Rows) -> Rows:
    rows: Rows = []
    for row in manoeuvres:
        quantities = (
            (("gravity", "m/s²", GRAVITY, 5e-3, 6e-6), ("rate_up", "rad/s", 3.7e-5, 1e-5, 2e-7))
            if row["do"] == "rest"
            else (("angle", "rad", row["angle"], 4e-3, 2.4e-5),)
        )
        for quantity, unit, expected, before, sigma in quantities:
            off = 7.0 if quantity == "angle" and row["about_x"] else 0.4
            rows.append(
                {
                    "id": f"compensation/{quantity}/{row['manoeuvre']}",
                    "manoeuvre": row["manoeuvre"],
                    "quantity": quantity,
                    "unit": unit,
                    "expected": expected,
                    "expected_sigma": sigma / 10,
                    "before": expected + before,
                    "after": expected + off * sigma,
                    "after_sigma": sigma,
                    "in_sigmas_after": off,
                    "sentence": f"{row['manoeuvre']}: {quantity}.",
                }
            )
    return rows


def residuals(manoeuvres: Rows, generator: np.random.Generator) -> Rows:
    """Sixty means of each manoeuvre, of which noise alone is left; the z gyro has twice its σ."""
    rows = []
    for row in manoeuvres:
        phase = "steady" if row["do"] == "turn" else "rest"
        for second in range(60):
            one = {"manoeuvre": row["manoeuvre"], "phase": phase, "time": 5.0 * second}
            for channel in tables.CHANNELS:
                sigma = 5e-5 if channel.startswith("accel") else 2e-6
                size = 2 * sigma if channel == "gyro_z" else sigma
                one[f"residual_{channel}"] = generator.normal(0, size)
                one[f"sigma_{channel}"] = sigma
            rows.append({"mount": "", "seconds": 5.0, **one})
    return rows


def characteristics() -> Rows:
    """A linearity error of 30 ppm of 10 °/s, and why there is none of another axis."""
    row = {
        "id": "compensation/gyro/linearity_error_x",
        "sensor": "gyro",
        "axis": "x",
        "quantity": "linearity_error",
        "value": 3e-5,
        "sigma": 4e-6,
        "lower": None,
        "by_noise": 1.1e-5,
        "unit": "1",
        "largest_input": np.radians(10),
        "input_unit": "rad/s",
        "points": 8,
        "reason": "",
    }
    nothing = dict.fromkeys(("value", "sigma", "by_noise", "largest_input")) | {"axis": "y"}
    other = {"id": "compensation/gyro/linearity_error_y", "reason": "nothing was applied"}
    return [row, row | nothing | other | {"points": 0}]


def navigation() -> dict[str, Rows]:
    """A rest, predicted for ten minutes, and a turn; the bias of a gyro limits all of them."""
    numbers = {"nominal": 4.0, "calibrated": 0.3, "predicted": 0.4, "by_parameters": 0.2}
    errors = [
        {
            "id": f"navigation/{quantity}/{manoeuvre}/{seconds:.0f}",
            "manoeuvre": manoeuvre,
            "motion": motion,
            "seconds": seconds,
            "quantity": quantity,
            "unit": unit,
            **(numbers if reason == "" else {"predicted": 0.4, "by_parameters": 0.2}),
            "normalised": 0.9 if reason == "" else None,
            "azimuth": "gyros",
            "reason": reason,
        }
        for quantity, unit in (("attitude", "rad"), ("velocity", "m/s"), ("position", "m"))
        for manoeuvre, motion, seconds, reason in (
            ("x-up", "rest", 60.0, ""),
            ("x-up", "rest", 600.0, "it is not recorded for so long"),
            ("x-forward", "turn", 48.5, ""),
        )
    ]
    rests = [row for row in errors if row["reason"] == "" and row["motion"] == "rest"]
    courses = [
        {name: row[name] for name in ("manoeuvre", "quantity", "unit")}
        | {"seconds": seconds}
        | {name: row[name] * seconds for name in ("nominal", "calibrated", "predicted")}
        for row in rests
        for seconds in (0.0, 30.0, 60.0)
    ]
    shares = [
        {"motion": row["motion"], "quantity": row["quantity"], "family": family, "source": source}
        | {"seconds": None if row["motion"] == "turn" else row["seconds"], "share": share}
        for row in errors
        for family, source, share in (
            ("gyro bias", "bias_x", 0.6),
            ("gyro gyro_g_sensitivity", "gyro_g_sensitivity.g_xx", 0.1),
            ("noise", "white_noise", 0.3),
        )
    ]
    return {
        "navigation_errors": errors,
        "navigation_courses": courses,
        "navigation_shares": shares,
    }


def repeated() -> dict[str, Rows]:
    """Three calibrations of a gyro, one scatter of days that are also switch-ons, and a jump."""
    key = {"sensor": "gyro", "quantity": "bias_x", "unit": "rad/s", "calibrations": 3}
    nothing = {"groups": 3, "value": None, "sigma": None, "upper": None, "reason": ""}
    components = [
        {"component": "within", "value": 1e-7},
        {"component": "repeatability", "value": 6e-7, "sigma": 2e-7},
        {"component": "day + switch_on", "value": 5e-7, "sigma": 2e-7, "upper": 1.2e-6},
        {"component": "mounting", "groups": 1, "reason": "all share one mounting"},
        {"component": "power_cycle", "groups": 8, "value": 5e-7, "sigma": 1e-7, "upper": 8e-7},
        {"component": "stability", "groups": 30, "value": 2e-7, "sigma": 3e-8},
    ]
    dates = {"from_date": "2025-01-02", "to_date": "2026-01-02", "at": "2026-07-02"}
    numbers = {"drift": 1e-7, "drift_sigma": 3e-7, "low": -1e-6, "median": 0.0, "high": 1e-6}
    return {
        "repeatability": [key | nothing | component for component in components],
        "changes": [
            {"sensor": "accel", "quantity": "scale_x", "unit": "1", "size": 5e-4, "sigma": 2e-5}
            | {"since": "2025-07-02", "since_campaign": "b", "p_value": 1e-9, "beyond": True}
        ],
        "jumps": [
            {**{k: key[k] for k in ("sensor", "quantity", "unit")}, "size": 2e-6, "sigma": 1e-7}
            | {"after": "2025-01-02", "after_campaign": "a", "until": "2025-07-02"}
            | {"until_campaign": "b", "p_value": 1e-4, "sentence": "The bias jumped."}
        ],
        "forecast": [key | dates | numbers | {"due": "2026-09-01", "reason": ""}],
    }


def compensated(traces: pd.DataFrame) -> pd.DataFrame:
    """The same envelopes with the biases taken out."""
    after = traces.copy()
    for sensor, biases in BIAS.items():
        for axis, bias in zip(AXES, biases, strict=True):
            columns = [f"least_{sensor}_{axis}", f"most_{sensor}_{axis}"]
            after[columns] = after[columns] - bias
    return after


def archived() -> dict[str, Any]:
    return {
        "file": "simulated/NovAtel+SPAN-CPT/SIM-001/2026-11-02-made-up.parquet",
        "sha256": "5a" * 32,
        "content": "c3" * 32,
        "supersedes": "",
    }


def budget() -> Rows:
    """Two sources of two parameters, 3 to 4 in sigma."""
    return [
        {"mount": "", "sensor": sensor, "quantity": name, "source": source, "unit": "1"}
        | {"sigma": 1e-6 * part, "share": part**2 / 25}
        for sensor in ("accel", "gyro")
        for name in ("scale_x", "scale_y")
        for source, part in (("noise", 3.0), ("gravity", 4.0))
    ]


def earlier(made: dict[str, Any], generator: np.random.Generator) -> Rows:
    rows: Rows = []
    for date in ("2025-06-30", "unknown"):
        for stage in ("accelerometer", "gyroscope"):
            for row in made[f"{stage}_parameters"].query("method == 'joint'").itertuples():
                rows.append(
                    {
                        "campaign": f"campaign of {date}",
                        "date": date,
                        "table": "three-axis",
                        "file": f"simulated/NovAtel+SPAN-CPT/SIM-001/{date}.parquet",
                        "id": row.id,
                        "sensor": row.sensor,
                        "quantity": row.parameter,
                        "value": row.value + row.sigma * generator.standard_normal(),
                        "sigma": row.sigma,
                        "unit": row.unit,
                    }
                )
    return rows
