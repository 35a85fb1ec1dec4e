"""The tables of a made-up campaign as S0 ran it: six rests, six turns, one of them not whole."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas as pd
import pyarrow as pa

from stages.contracts import tables
from stages.report import Documents, report
from stages.studies import WRITES as STUDIES
from tests.reporting import made_up_causes
from tests.reporting.made_up_studies import studies

GRAVITY = 9.7936174
DEGREE = np.pi / 180
INTERVAL = 0.01
REST_S, TURN_S = 300.0, 58.0
GAP = (21.89, 33.87)
GAP_LINE = 2192  # the first record after it, numbered from 0; lines are numbered from 1
GAP_FINDING = "quality/gap/z-backward.asc/2192"
RINGING_FINDING = "quality/oscillation/gyro_x"
AXES = "xyz"
PAIRS = [(i, j) for i in range(3) for j in range(3) if i != j]
SCALE = {"accel": (3.2852e-4, 3.2826e-4, 2.3567e-4), "gyro": (6.151e-4, -1.62e-5, 6.442e-4)}
CROSS = (0.0021831, 0.0076080, -0.0027442, -0.0007839, -0.0075585, 0.0007016)
BIAS = {"accel": (-0.0052949, 0.0050641, -0.0018790), "gyro": (1.30e-6, -2.10e-6, 0.90e-6)}
NOISE = {"accel": 1.07e-3, "gyro": 3.5e-5}
BATCH = 700  # rows, so that a turn comes in several batches
Rows = list[dict[str, Any]]


@dataclass(frozen=True)
class Held:
    """A table that is handed over as a stream."""

    frame: pd.DataFrame

    def columns(self, names: list[str]) -> Iterator[pa.RecordBatch]:
        yield from pa.Table.from_pandas(self.frame[names]).to_batches(max_chunksize=BATCH)


@cache
def documents() -> Documents:
    """The report on it, with the raw data of a rest and of the turn that is not whole."""
    return report(**campaign(logs=("x-up.asc", "z-backward.asc")))


def brief(*logs: str) -> dict[str, Any]:
    """The same with few figures, for drawing takes its time: the raw data of `logs` alone."""
    made = campaign(logs)
    figures = ("noise", "accelerometer_averaging", "gyroscope_averaging", "fidelity", "earlier")
    less = {name: made[name].iloc[:0] for name in (*figures, *STUDIES, "compensated_traces")}
    return made | less


def campaign(logs: Collection[str] | None = None) -> dict[str, Any]:
    """What the report takes, by name; where `logs` are given, raw data of these alone."""
    generator = np.random.default_rng(20231018)
    manoeuvres = _manoeuvres()
    traces = [_trace(row, generator) for row in manoeuvres if logs is None or row["log"] in logs]
    made: dict[str, Any] = {
        "campaign": rows_as(tables.CAMPAIGN, [_about()]),
        "known": rows_as(tables.KNOWN, _known()),
        "sensors": rows_as(tables.SENSORS, _sensors()),
        "inputs": rows_as(tables.INPUTS, _inputs(manoeuvres)),
        "manoeuvres": rows_as(tables.MANOEUVRES, manoeuvres),
        "accounts": rows_as(tables.ACCOUNTS, _accounts(manoeuvres)),
        "refused": rows_as(tables.REFUSED, _refused()),
        "clocks": rows_as(tables.CLOCKS, _clocks(manoeuvres)),
        "quality_findings": rows_as(tables.FINDINGS, _quality_findings()),
        "masks": tables.MASKS.empty(),
        "gaps": rows_as(tables.GAPS, [_gap()]),
        "quality_close_ups": pd.concat([_gap_close_up(generator), _ringing(generator)]),
        "segment_findings": rows_as(tables.FINDINGS, _segment_findings()),
        "segment_close_ups": tables.CLOSE_UPS.empty(),
        "segments": rows_as(tables.SEGMENTS, _segments(manoeuvres)),
        "performed": rows_as(tables.PERFORMED, _performed(manoeuvres)),
        "traces": pd.concat(traces, ignore_index=True) if traces else tables.TRACES.empty(),
        "noise": rows_as(tables.NOISE, _noise(manoeuvres, generator)),
    }
    for stage, other in (("accelerometer", "six_position"), ("gyroscope", "turns")):
        parameters = _parameters(stage, "joint") + _parameters(stage, other)
        made[f"{stage}_parameters"] = rows_as(tables.PARAMETERS, parameters)
        made[f"{stage}_fit"] = rows_as(tables.FIT, _fit(stage, other))
        made[f"{stage}_averaging"] = rows_as(tables.AVERAGING, _averaging(parameters, generator))
        made[f"{stage}_wanted"] = rows_as(tables.WANTED, _wanted(stage, other))
    made |= _of_the_model(manoeuvres, made["gyroscope_parameters"], generator)
    made |= _criticised()
    for name, rows in studies(np.random.default_rng(1)).items():
        made[name] = rows_as(STUDIES[name], rows)
    made["checks"] = rows_as(tables.CHECKS, _checks(manoeuvres))
    made["compensated_traces"] = _compensated(made["traces"])
    made["differences"] = rows_as(tables.DIFFERENCES, _differences())
    made["archived"] = rows_as(tables.ARCHIVED, [_archived()])
    made["earlier"] = rows_as(tables.EARLIER, _earlier(made, generator))
    maker: dict[str, Any] = {
        "settings": {"rest_block": 5.0},
        "code": "c0de" * 16,
        "inputs": {"demo/a": "0" * 64},
    }
    stages = {"quality_findings": "quality", "noise": "noise", "extended_parameters": "extension"}
    made["provenance"] = {
        name: {"stage": stages.get(name, name.partition("_")[0]), **maker} for name in made
    }
    return made


def poor() -> dict[str, Any]:
    """The same with every table empty but the campaign's own."""
    made = campaign()
    provenance = made.pop("provenance")
    simulated = Held(made.pop("simulated").frame.iloc[:0])
    empty = {name: frame.iloc[:0] for name, frame in made.items()} | {"simulated": simulated}
    return {**empty, "campaign": made["campaign"], "provenance": provenance}


def rows_as(table: Any, rows: Rows) -> pd.DataFrame:
    """Rows with the columns of the contract; what a row leaves out is a gap."""
    names = [column.name for column in table.columns]
    unknown = {name for row in rows for name in row} - set(names)
    assert not unknown, unknown
    frame = pd.DataFrame([{name: row.get(name) for name in names} for row in rows], columns=names)
    return pd.DataFrame(table.arrow(frame).to_pandas())


def _about() -> dict[str, Any]:
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


def _known() -> Rows:
    arc_second = DEGREE / 3600
    return [
        {"quantity": q, "value": value, "sigma": sigma, "unit": unit, "origin": origin}
        for q, value, sigma, unit, origin in (
            ("gravity", GRAVITY, 5e-5, "m/s²", "stated: site.gravity_m_s2"),
            (
                "earth_rate_up",
                3.7039e-5,
                1.1e-8,
                "rad/s",
                "computed from the latitude, whose sigma is assumed as 0.01°",
            ),
            (
                "earth_rate_level",
                6.2813e-5,
                None,
                "rad/s",
                "computed from the latitude, whose sigma is assumed as 0.01°",
            ),
            ("heading", None, None, "rad", "not known"),
            ("position", 0.0, 2 * arc_second, "rad", "stated: table.position_sigma_arcsec"),
            ("turn_angle", 0.0, 2 * arc_second, "rad", "stated: table.angle_sigma_arcsec"),
            ("turn_rate", 0.0, 1e-3, "1", "assumed, for table.rate_sigma_ppm is not stated"),
        )
    ]


def _sensors() -> Rows:
    source = "count: NovAtel, RAWIMU scale factors; noise: NovAtel SPAN-CPT data sheet"
    white = {"accel": 0.0324 / 60, "gyro": 0.0667 * DEGREE / 60}
    return [
        {
            "channel": channel,
            "white_noise": white[channel[:-2]],
            "source": source,
        }
        for channel in tables.CHANNELS
    ]


def _manoeuvres() -> Rows:
    rows: Rows = []
    common = {"mount": "as mounted", "recorded": "whole"}
    for i, axis in enumerate(AXES):
        for name, sign in (("up", 1.0), ("down", -1.0)):
            identifier = f"{axis}-{name}"
            rows.append(
                common
                | {"manoeuvre": identifier, "position": identifier, "log": f"{identifier}.asc"}
                | {"do": "rest", "seconds": REST_S}
                | {f"up_{a}": sign * (i == j) for j, a in enumerate(AXES)}
            )
    for i, axis in enumerate(AXES):
        for name, sign in (("forward", 1.0), ("backward", -1.0)):
            identifier = f"{axis}-{name}"
            rows.append(
                common
                | {"manoeuvre": identifier, "position": identifier, "log": f"{identifier}.asc"}
                | {"do": "turn", "seconds": 38.0, "angle": sign * 2 * np.pi}
                | {"angle_sigma": 1e-5, "rate": sign * 10 * DEGREE, "acceleration": 5 * DEGREE}
                | {f"up_{a}": 1.0 * (i == j) for j, a in enumerate(AXES)}
                | {f"about_{a}": 1.0 * (i == j) for j, a in enumerate(AXES)}
            )
    return rows


def _seconds(row: dict[str, Any]) -> float:
    return REST_S if row["do"] == "rest" else TURN_S


def _inputs(manoeuvres: Rows) -> Rows:
    rows: Rows = [{"file": "campaign.yaml", "size": 1326, "sha256": "ab" * 32}]
    for number, row in enumerate(manoeuvres):
        sha256 = f"{number:02x}" * 32
        rows.append(
            {"file": row["log"], "size": round(_seconds(row) * 8700) + 900, "sha256": sha256}
        )
    return rows


def _accounts(manoeuvres: Rows) -> Rows:
    rows: Rows = []
    for row in manoeuvres:
        lines = round(_seconds(row) / INTERVAL)
        size = round(_seconds(row) * 8700)
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


def _refused() -> Rows:
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


def _clocks(manoeuvres: Rows) -> Rows:
    return [
        {
            "log": row["log"],
            "clock": "GPS",
            "epoch_gps": 1.4e9,
            "recorded_on": "2026-11-02",
            "from_s": 0.0,
            "to_s": _seconds(row),
            "records": round(_seconds(row) / INTERVAL),
            "interval": INTERVAL,
        }
        for row in manoeuvres
    ]


def _quality_findings() -> Rows:
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


def _segment_findings() -> Rows:
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


def _gap() -> dict[str, Any]:
    missing = round((GAP[1] - GAP[0]) / INTERVAL) - 1
    stretch = {"from_s": GAP[0], "to_s": GAP[1], "missing": missing}
    return {"log": "z-backward.asc", "record": GAP_LINE, **stretch}


def _gap_close_up(generator: np.random.Generator) -> pd.DataFrame:
    """Sixty records on both sides of the gap, as S0 shows its lines 2192 and 2193."""
    places = np.arange(-60, 60)
    time = np.where(places < 0, GAP[0] + (places + 1) * INTERVAL, GAP[1] + places * INTERVAL)
    record = GAP_LINE + places
    return close_up(GAP_FINDING, "z-backward", record, time, generator, concerned=places == 99)


def _ringing(generator: np.random.Generator) -> pd.DataFrame:
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
    [row] = [row for row in _manoeuvres() if row["manoeuvre"] == manoeuvre]
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
        rate = _rate(row, time) * (row.get(f"about_{axis}") or 0.0) + BIAS["gyro"][i]
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


def _segments(manoeuvres: Rows) -> Rows:
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


def _performed(manoeuvres: Rows) -> Rows:
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


def _rate(row: dict[str, Any], time: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    if row["do"] == "rest":
        return np.zeros_like(time)
    ramp = np.clip((time - 10) / 2, 0, 1) - np.clip((time - 46) / 2, 0, 1)
    return np.asarray(ramp * row["rate"])


def _trace(row: dict[str, Any], generator: np.random.Generator) -> pd.DataFrame:
    """The envelope of a log: a hundred and some samples a row."""
    per_row = 50 if row["do"] == "rest" else 12
    time = np.arange(0, _seconds(row), INTERVAL)
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
        turn = _rate(row, pieces) * (row.get(f"about_{axis}") or 0.0) + BIAS["gyro"][i]
        turning = row["do"] == "turn" and axis == "x" and row["about_x"] == 1.0
        turn = turn + 0.01 * turning * np.sin(2 * np.pi * 20 * pieces) * (_rate(row, pieces) != 0)
        for name, value, noise in (("accel", force, 1.07e-3), ("gyro", turn, 3.5e-5)):
            samples = value + noise * generator.standard_normal(pieces.shape)
            columns[f"least_{name}_{axis}"] = samples.min(axis=1)
            columns[f"most_{name}_{axis}"] = samples.max(axis=1)
    return pd.DataFrame(columns)


def _noise(manoeuvres: Rows, generator: np.random.Generator) -> Rows:
    white = {"accel": 1.07e-4, "gyro": 3.49e-6}
    sheet = {row["channel"]: row["white_noise"] for row in _sensors()}
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


def _parameters(stage: str, method: str) -> Rows:
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


def _fit(stage: str, other: str) -> Rows:
    left_out = "z-backward: 119.8° of 360° are missing" if stage == "gyroscope" else ""
    p_value = 2.4e-9 if stage == "gyroscope" else 0.41
    chi_squared = 812.4 if stage == "gyroscope" else 603.1
    used = "x-up, x-down, y-up, y-down, z-up, z-down, x-forward, x-backward, y-forward"
    noise = {"scatter": 0.0, "random_walk": 0.0, "random_walk_sigma": 0.0}
    noise |= {"unit": tables.UNITS["accel" if stage == "accelerometer" else "gyro"]}
    row = {"chi_squared": chi_squared, "degrees": 594, "p_value": p_value, "used": used}
    plain = {"chi_squared": 5.1, "degrees": 6, "p_value": 0.53, "used": "x-up, x-down, y-up"}
    return [
        {"method": "joint", "left_out": left_out, **row, **noise},
        {"method": other, "left_out": left_out, **plain, **noise},
    ]


def _averaging(parameters: Rows, generator: np.random.Generator) -> Rows:
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
                {"parameter": parameter["id"], "seconds": seconds, "value": value, "sigma": sigma}
            )
    return rows


def _wanted(stage: str, method: str) -> Rows:
    sigma, floor = (9e-5, 3e-5) if stage == "accelerometer" else (7e-7, 0.0)
    row = {"seconds": REST_S, "sigma": sigma, "floor": floor, "random_walk": sigma * REST_S**0.5}
    times = {"x": (2 * sigma, 60.0), "y": (sigma / 2, 1200.0), "z": (floor / 2, None)}
    return [
        {"parameter": f"{stage}/{method}/bias_{axis}", "wanted": wanted, "wanted_seconds": time}
        | row
        for axis, (wanted, time) in times.items()
    ]


# ---- simulation, criticism, extension


def _of_the_model(
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
        "decision": rows_as(tables.DECISION, _decision()),
        "extended_parameters": rows_as(tables.PARAMETERS, _extended(parameters)),
        "extended_fit": rows_as(tables.FIT, _extended_fit()),
        "accelerometer_findings": tables.FINDINGS.empty(),
        "compensation_findings": tables.FINDINGS.empty(),
    }


def _simulated(row: dict[str, Any], generator: np.random.Generator) -> pd.DataFrame:
    time = np.arange(0, TURN_S, INTERVAL)
    columns: dict[str, Any] = {
        "manoeuvre": row["manoeuvre"],
        "phase": "steady",
        "log": row["log"],
        "record": np.arange(len(time)),
        "time": time,
    }
    for i, axis in enumerate(AXES):
        columns[f"accel_{axis}"] = np.full(len(time), GRAVITY * row[f"up_{axis}"])
        columns[f"gyro_{axis}"] = _rate(row, time) * row[f"about_{axis}"] + BIAS["gyro"][i]
    ringing = 0.01 * np.sin(2 * np.pi * 20 * time + 0.3) * (_rate(row, time) != 0)
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
        needless |= {"degrees": 3, "p_value": 0.38, "verdict": "", "members": ""}
        said = f"No {effect} is needed (p = 0.38)."
        return {
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
            sentence="The data ask for gyro g sensitivity.",
        ),
        score("lever_arm", "the accelerometers stand beside the axis of the table"),
        score("accel_quadratic", "the suspension of the proof mass is not symmetric"),
        score("table_tilt", "the base of the table is not level", degrees=0, p_value=1.0)
        | {"sentence": "This campaign cannot show table tilt. No manoeuvre excites it."},
        score(
            "oscillation",
            "the case or the table's drive vibrates about one axis",
            sought_in="spectrum",
            p_value=0.0,
            named=True,
            sentence="The case oscillates about x while the table turns: 20.000 Hz.",
        ),
    ]


def _effects() -> Rows:
    def effect(
        name: str, parameter: str, unit: str, value: float | None, sigma: float | None
    ) -> dict[str, Any]:
        return {
            "id": f"criticism/{name}/{parameter}",
            "effect": name,
            "parameter": parameter,
            "value": value,
            "sigma": sigma,
            "visible": None if sigma is None else 5 * sigma,
            "unit": unit,
            "meaning": f"{parameter} of {name}",
        }

    g = "gyro_g_sensitivity"
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
    rows.append(effect("oscillation", "frequency", "Hz", 20.0, 6.6e-7) | {"visible": None})
    rows.append(effect("oscillation", "amplitude", "rad/s", 0.01, 4.1e-7))
    return rows


def _lines(turns: Rows) -> Rows:
    return [
        {
            "manoeuvre": row["manoeuvre"],
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
        "effects": "gyro_g_sensitivity",
        "rows": 1996,
        "unit": "sigma",
        "mount": "",
    }
    line = {
        "sensor": "gyro x",
        "effects": "oscillation",
        "rows": 17000,
        "unit": "rad/s",
        "mount": "",
    }
    channel = g | {"sensor": "gyro y", "rows": 74, "before": 90.0, "after": 71.0, "drop": 19.0}
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


def _decision() -> Rows:
    told = {
        "gyro": "The extended result of the gyros counts, with gyro g-sensitivity.",
        "accel": "The joint result of the accelerometers counts: they show no effect.",
    }
    return [
        {
            "sensor": sensor,
            "mount": "",
            "result": "extended" if sensor == "gyro" else "joint",
            "effects": "gyro_g_sensitivity" if sensor == "gyro" else "",
            "alarms": "",
            "sentence": sentence,
        }
        for sensor, sentence in told.items()
    ]


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


def _criticised() -> dict[str, Any]:
    return {
        "criticism_findings": rows_as(tables.CAUSES, made_up_causes.findings()),
        "blind_spots": rows_as(tables.BLIND_SPOTS, made_up_causes.blind_spots()),
        "structures": rows_as(tables.STRUCTURES, made_up_causes.structures()),
        "structure_points": tables.STRUCTURE_POINTS.empty(),
    }


def _extended_fit() -> Rows:
    row = _fit("gyroscope", "turns")[0]
    return [row | {"method": "gyroscope", "chi_squared": 590.0, "p_value": 0.54}]


def _extended(parameters: pd.DataFrame) -> Rows:
    """The gyro's twelve, the first bias moved by four sigma."""
    rows: Rows = []
    for row in parameters.query("method == 'joint'").to_dict("records"):
        if row["parameter"].partition("_")[0] in ("bias", "scale", "cross"):
            moved = 4 * row["sigma"] * (row["parameter"] == "bias_x")
            identifier = f"extension/gyroscope/{row['parameter']}"
            own = {"id": identifier, "stage": "extension", "method": "gyroscope"}
            rows.append({str(k): v for k, v in row.items()} | own | {"value": row["value"] + moved})
    return rows


# ---- comparison, compensation, history


def _differences() -> Rows:
    def row(
        kind: str, parameter: str, unit: str, sigmas: float | None, said: str
    ) -> dict[str, Any]:
        one = {
            "id": f"comparison/{kind}/{parameter}",
            "kind": kind,
            "parameter": parameter,
            "unit": unit,
            "first": "this",
            "second": "that",
            "first_value": 2e-6,
            "second_value": 1e-6,
            "sentence": said,
        }
        if sigmas is None:
            return one
        sigma = abs(1e-6 / sigmas)
        p_value = 1e-9 if abs(sigmas) > 5 else 0.4
        difference = {"difference": np.sign(sigmas) * 1e-6, "sigma": sigma}
        return one | difference | {"in_sigmas": sigmas, "p_value": p_value}

    return [
        row("method_against_method", "gyroscope/bias_y", "rad/s", 0.9, "bias: they agree."),
        row("method_against_method", "gyroscope/scale_x", "1", None, "nothing to compare."),
        row(
            "static_against_turns",
            "gyroscope/bias_x",
            "rad/s",
            -13.2,
            "bias of the x gyro: rests and turns differ by 0.2 °/h: more than chance.",
        ),
    ]


def _checks(manoeuvres: Rows) -> Rows:
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


def _compensated(traces: pd.DataFrame) -> pd.DataFrame:
    """The same envelopes with the biases taken out."""
    after = traces.copy()
    for sensor, biases in BIAS.items():
        for axis, bias in zip(AXES, biases, strict=True):
            columns = [f"least_{sensor}_{axis}", f"most_{sensor}_{axis}"]
            after[columns] = after[columns] - bias
    return after


def _archived() -> dict[str, Any]:
    return {
        "file": "simulated/NovAtel+SPAN-CPT/SIM-001/2026-11-02-made-up.parquet",
        "sha256": "5a" * 32,
        "content": "c3" * 32,
        "supersedes": "",
    }


def _earlier(made: dict[str, Any], generator: np.random.Generator) -> Rows:
    rows: Rows = []
    for date in ("2025-06-30", "unknown"):
        for stage in ("accelerometer", "gyroscope"):
            for row in made[f"{stage}_parameters"].query("method == 'joint'").itertuples():
                rows.append(
                    {
                        "campaign": f"campaign of {date}",
                        "date": date,
                        "file": f"simulated/NovAtel+SPAN-CPT/SIM-001/{date}.parquet",
                        "id": row.id,
                        "value": row.value + row.sigma * generator.standard_normal(),
                        "sigma": row.sigma,
                        "unit": row.unit,
                    }
                )
    return rows
