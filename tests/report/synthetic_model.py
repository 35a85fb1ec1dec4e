"""What simulation, criticism and extension say of the synthetic campaign."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from tests.report import synthetic_causes, synthetic_diagnosis
from tests.report import synthetic_estimates as estimates
from tests.report.synthetic_recording import rate_of
from tests.report.synthetic_values import (
    AXES,
    BIAS,
    GRAVITY,
    INTERVAL,
    NOISE,
    TURN_S,
    Held,
    Rows,
    rows_as,
)


def of_the_model(
    manoeuvres: Rows, parameters: pd.DataFrame, generator: np.random.Generator
) -> dict[str, Any]:
    """What the simulation gave, what it lacks, and what the extension gained."""
    turns = [row for row in manoeuvres if row["do"] == "turn" and row["manoeuvre"] != "z-backward"]
    simulated = pd.concat([_simulated(row, generator) for row in turns], ignore_index=True)
    return {
        "simulated": Held(simulated),
        "fidelity": rows_as(tables.FIDELITY, _fidelity(manoeuvres, turns)),
        "scores": rows_as(tables.SCORES, _scores()),
        "effects": rows_as(tables.EFFECTS, _effects()),
        "lines": rows_as(tables.LINES, _lines(turns)),
        "gain": rows_as(tables.GAIN, _gain()),
        "worth": rows_as(tables.WORTH, _worth()),
        "gain_effects": rows_as(tables.GAIN_EFFECTS, _gain_effects()),
        "held_out": tables.HELD_OUT.empty(),
        "verdict": rows_as(tables.VERDICTS, synthetic_diagnosis.verdicts()),
        "candidate_effects": rows_as(
            tables.CANDIDATE_EFFECTS, [OF_GYRO | {"method": "extended", "finding": ""}]
        ),
        "extended_parameters": rows_as(tables.PARAMETERS, _extended(parameters)),
        "extended_fit": rows_as(tables.FIT, _extended_fit()),
        "gyroscope_switch_ons": rows_as(tables.SWITCH_ONS, _switch_ons()),
        "accelerometer_switch_ons": tables.SWITCH_ONS.empty(),
        "extended_fit_manoeuvres": rows_as(tables.FIT_MANOEUVRES, _extended_manoeuvres()),
        "accelerometer_findings": tables.FINDINGS.empty(),
        "gyroscope_findings": tables.FINDINGS.empty(),
        "noise_findings": tables.FINDINGS.empty(),
        "compensation_findings": tables.FINDINGS.empty(),
    }


def _switch_ons() -> list[dict[str, Any]]:
    """Of one switch-on, two axes of three."""
    row = {"mount": "", "sensor": "gyro", "method": "joint", "unit": "rad/s", "switch_on": 0}
    return [row | {"axis": axis, "value": 1e-6, "sigma": 2e-7} for axis in "xy"]


def _simulated(row: dict[str, Any], generator: np.random.Generator) -> pd.DataFrame:
    time = np.arange(0, TURN_S, INTERVAL)
    rate = rate_of(row, time)
    columns: dict[str, Any] = {
        "manoeuvre": row["manoeuvre"],
        "phase": "steady",
        "log": row["log"],
        "record": np.arange(len(time)),
        "time": time,
    }
    for i, axis in enumerate(AXES):
        columns[f"accel_{axis}"] = np.full(len(time), GRAVITY * row[f"up_{axis}"])
        columns[f"gyro_{axis}"] = rate * row[f"about_{axis}"] + BIAS["gyro"][i]
    ringing = 0.01 * np.sin(2 * np.pi * 20 * time + 0.3) * (rate != 0)
    for channel in tables.CHANNELS:
        noise = NOISE[channel[:-2]] * generator.standard_normal(len(time))
        columns[f"residual_{channel}"] = noise + ringing * (channel == "gyro_x")
    frame = pd.DataFrame(columns)[[column.name for column in tables.SIMULATED.columns]]
    return pd.DataFrame(tables.SIMULATED.arrow(frame).to_pandas())


def _fidelity(manoeuvres: Rows, turns: Rows) -> Rows:
    rows: Rows = []
    for row in [*turns, *(row for row in manoeuvres if row["do"] == "rest")]:
        for channel in tables.CHANNELS:
            noise = NOISE[channel[:-2]]
            loud = channel == "gyro_x" and row["do"] == "turn"
            rows.append(
                {
                    "manoeuvre": row["manoeuvre"],
                    "channel": channel,
                    "profile": "trapezoid" if row["do"] == "turn" else "at rest",
                    "residual_rms": noise * (147.0 if loud else 1.03),
                    "noise_rms": noise,
                    "samples": 5800,
                }
            )
    return rows


def _scores() -> Rows:
    def score(effect: str, cause: str, **more: Any) -> dict[str, Any]:
        needless: dict[str, Any] = {"sought_in": "blocks", "statistic": 3.1, "named": False}
        needless |= {"degrees": 3, "p_value": 0.38, "verdict": ""}
        said = f"No {effect} is needed (p = 0.38)."
        return {
            "mount": "",
            "effect": effect,
            "cause": cause,
            **needless,
            "named": False,
            "sentence": said,
        } | more

    return [
        score(
            "gyro_g_sensitivity",
            "mass unbalance pulls the gyro off null under load",
            statistic=5860.7,
            degrees=9,
            p_value=0.0,
            named=True,
            finding="criticism/gyro_g_sensitivity",
            sentence="The data ask for gyro g sensitivity.",
        ),
        score("lever_arm", "the accelerometers stand beside the axis of the table"),
        score("accel_quadratic", "the suspension of the proof mass is not symmetric"),
        score("table_tilt", "the base of the table is not level", degrees=None, p_value=None)
        | {"sentence": "This campaign cannot show table tilt. No manoeuvre excites it."},
        score(
            "oscillation",
            "the case or the table's drive vibrates about one axis",
            sought_in="spectrum",
            p_value=0.0,
            named=True,
            finding="criticism/oscillation",
            sentence="The case oscillates about x while the table turns: 20.000 Hz.",
        ),
    ]


def _effects() -> Rows:
    g = "gyro_g_sensitivity"

    def effect(
        name: str, parameter: str, unit: str, value: float | None, sigma: float | None
    ) -> dict[str, Any]:
        return {
            "id": f"criticism/{name}/{parameter}",
            "mount": "",
            "finding": f"criticism/{name}" if name in (g, "oscillation") else None,
            "effect": name,
            "parameter": parameter,
            "value": value,
            "sigma": sigma,
            "detection_limit": None if sigma is None else 5 * sigma,
            "unit": unit,
            "meaning": f"{parameter} of {name}",
        }

    rows = [
        effect(g, f"g_{i}{j}", "(rad/s)/(m/s²)", 6.92e-7 if i == j else 2.9e-8, 1.38e-8)
        for i in AXES
        for j in AXES
    ]
    rows += [effect("lever_arm", f"r_{axis}", "m", 1e-4, 3.3e-4) for axis in AXES]
    rows += [
        effect("accel_quadratic", f"k2_{axis}", "(m/s²)/(m/s²)²", 2.8e-7, 4.1e-7) for axis in AXES
    ]
    rows += [effect("table_tilt", way, "rad", None, None) for way in ("north", "east")]
    rows.append(effect("oscillation", "frequency", "Hz", 20.0, 6.6e-7) | {"detection_limit": None})
    rows.append(effect("oscillation", "amplitude", "rad/s", 0.01, 4.1e-7))
    return rows


def _lines(turns: Rows) -> Rows:
    return [
        {
            "manoeuvre": row["manoeuvre"],
            "mount": "",
            "axis": axis,
            "frequency": 20.0 if axis == "x" else 31.7,
            "frequency_sigma": 1e-6 if axis == "x" else 3e-3,
            "amplitude": 0.01 if axis == "x" else 4e-6,
            "amplitude_sigma": 9e-7,
            "p_value": 0.0 if axis == "x" else 0.4,
        }
        for row in turns
        for axis in AXES
    ]


def _gain() -> Rows:
    g = {
        "sensor": "gyro",
        "model": "blocks",
        "rows": 1996,
        "unit": "sigma",
        "mount": "",
    }
    line = {
        "sensor": "gyro",
        "axis": "x",
        "model": "oscillation",
        "rows": 17000,
        "unit": "rad/s",
        "mount": "",
    }
    channel = g | {"axis": "y", "rows": 74, "before": 90.0, "after": 71.0, "drop": 19.0}
    after = {"before": 4.4e-5, "after": 1.2e-9, "drop": 4.4e-5 - 1.2e-9}
    return [
        g
        | {"scope": "fitted", "before": 7740.0, "after": 1879.4, "drop": 5860.6}
        | {"rms_before": 1.969, "rms_after": 0.9703},
        g
        | {"scope": "held-out", "before": 12897.4, "after": 827.6, "drop": 12069.8}
        | {"snr_squared": 12191.7, "folds": 12, "counted": 12}
        | {"rms_before": 2.652, "rms_after": 0.9766},
        channel | {"scope": "held-out", "rms_before": 1.1, "rms_after": 0.98},
        *(
            line | after | {"scope": scope, "rms_before": 0.006615, "rms_after": 3.5e-5}
            for scope in ("fitted", "held-out")
        ),
    ]


OF_GYRO = {"mount": "", "sensor": "gyro", "effect": "gyro_g_sensitivity"}


def _gain_effects() -> Rows:
    of_line = {"model": "oscillation", "effect": "oscillation"}
    return [OF_GYRO | {"model": "blocks"}, OF_GYRO | of_line]


def _worth() -> Rows:
    """A gyro that is off by 1 °/h at rest, and less in a turn."""
    rate = np.radians(1 / 3600)
    return [
        {
            "manoeuvre": manoeuvre,
            "mount": "",
            "motion": motion,
            "rate": np.radians(10.0) * (motion == "turn"),
            "seconds": 60.0,
            "attitude_joint": size * rate * 60,
            "attitude_joint_sigma": 1e-6,
            "attitude_extended": 2e-6,
            "velocity_joint": size * 9.8 * rate * 1800,
            "velocity_joint_sigma": 3e-4,
            "velocity_extended": 6e-4,
        }
        for manoeuvre, motion, size in (("x-up", "rest", 1.0), ("x-forward", "turn", 0.1))
    ]


def criticised() -> dict[str, Any]:
    return {
        **synthetic_causes.cause_tables(synthetic_causes.findings()),
        "detection_limits": rows_as(tables.DETECTION_LIMITS, synthetic_causes.detection_limits()),
        "structures": rows_as(tables.STRUCTURES, synthetic_causes.structures()),
        "structure_points": tables.STRUCTURE_POINTS.empty(),
    }


def _extended_fit() -> Rows:
    row = estimates.fit("gyroscope", "turns")[0]
    return [row | {"method": "extended", "chi_squared": 590.0, "p_value": 0.54}]


def _extended_manoeuvres() -> Rows:
    rows = estimates.fit_manoeuvres("gyroscope", "turns")
    return [row | {"method": "extended"} for row in rows if row["method"] == "joint"]


def _extended(parameters: pd.DataFrame) -> Rows:
    """The gyro's twelve, the first bias moved by four sigma."""
    rows: Rows = []
    for row in parameters.query("method == 'joint'").to_dict("records"):
        if row["parameter"].partition("_")[0] in ("bias", "scale", "cross"):
            moved = 4 * row["sigma"] * (row["parameter"] == "bias_x")
            identifier = f"extension/gyroscope/{row['parameter']}"
            own = {"id": identifier, "stage": "extension", "method": "extended"}
            rows.append({str(k): v for k, v in row.items()} | own | {"value": row["value"] + moved})
    return rows
