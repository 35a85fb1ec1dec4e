"""Biases along the temperature: the cubic per axis of the autopilots beside this project.

PX4 (Tools/process_sensor_caldata.py) and ArduPilot (Tools/scripts/tempcal_IMU.py) fit a cubic of
the temperature to each axis of a sensor that lies in one attitude.
Both fits are numpy.polyfit of degree 3, here to the rests with z up of the same recording.
"""

import time
from collections.abc import Mapping
from typing import Any

import chain  # of the tests: the stages one after another in this process
import numpy as np
from temperature_draws import ICE_POINT, document_of

import laboratory
from benchmarks.tables import Table, digits
from inertial.arrays import Array

CAMPAIGNS = 3
POINTS = 41
MICRO_G, DEGREE_PER_HOUR = 9.80665e-6, np.pi / 180 / 3600
BESIDE = ("studies", "comparison")
REFERENCE = 27.0  # °C, from which changes are counted
ATTITUDE = "zup"  # ends the names of the rests with z up
HIDDEN: Mapping[str, Any] = {
    "accelerometer": {
        "bias_micro_g": {
            "x": {"powers": [60, 0.8]},
            "y": {"knee_deg_c": 30, "below": 40, "above": -80},
            "z": {"powers": [-50, 0.5, -0.02]},
        },
        "matrix_ppm": {"zz": {"powers": [30]}, "xz": {"powers": [5]}},
    },
    "gyro": {
        "bias_deg_h": {
            "x": {"powers": [3, 0.05, 0.001]},
            "y": {"knee_deg_c": 25, "below": -1, "above": 5},
            "z": {"powers": [-2]},
        },
        "matrix_ppm": {"yy": {"powers": [25]}},
    },
}


def measured() -> list[Table]:
    """Errors of the change of each bias over 75 K, and the processor time."""
    table = Table(
        "Change of the biases from −10 to 65 °C, scale factors changing as well: rms error",
        ("method", "accel\nµg", "gyro\n°/h", "95 % intervals\nhit", "processor\ns"),
    )
    rows: dict[str, list[tuple[float, ...]]] = {}
    for number in range(CAMPAIGNS):
        document = document_of("nodes") | {"effects": {"temperature_curves": HIDDEN}}
        document["temperature"] = document["temperature"] | {"reference_deg_c": REFERENCE}
        document["seed"] = number
        recording = laboratory.perform(laboratory.specify(document))
        for name, method in (("cubic per axis, one attitude", _polyfit), ("this project", _own)):
            rows.setdefault(name, []).append(method(recording))
    for name, each in rows.items():
        force, rate, hit, seconds = np.mean(each, axis=0)
        table.add(name, digits(force), digits(rate), digits(hit), digits(seconds))
    table.remarks.append(
        f"Mean of {CAMPAIGNS} campaigns of six positions and six turns at six temperatures. In one "
        "attitude the change of a scale factor or cross term under 1 g is taken for one of a bias; "
        "a cubic has no knee, and no sigma."
    )
    return [table]


def _truth(at: Array) -> Array:
    """The change of the six biases from the reference, (k, 6), accelerometers first."""
    columns = []
    for sensor, key, unit in (
        ("accelerometer", "bias_micro_g", MICRO_G),
        ("gyro", "bias_deg_h", DEGREE_PER_HOUR),
    ):
        for axis in "xyz":
            curve = HIDDEN[sensor][key][axis]
            d = at - ICE_POINT - REFERENCE
            if "powers" in curve:
                columns.append(unit * np.polyval([*curve["powers"][::-1], 0.0], d))
                continue
            knee = curve["knee_deg_c"] - REFERENCE
            bent = [
                np.where(x < knee, curve["below"], curve["above"]) * (x - knee)
                for x in (d, np.zeros(1))
            ]
            columns.append(unit * (bent[0] - bent[1]))
    return np.column_stack(columns)


def _judged(at: Array, change: Array, sigma: Array | None, seconds: float) -> tuple[float, ...]:
    """Rms errors about the mean over the range, for only the change is compared."""
    off = change - _truth(at)
    off = off - off.mean(axis=0)
    hit = np.nan if sigma is None else float(np.mean(np.abs(off) <= 1.959964 * sigma))
    force, rate = (float(np.sqrt(np.mean(off[:, part] ** 2))) for part in (slice(3), slice(3, 6)))
    return force / MICRO_G, rate / DEGREE_PER_HOUR, hit, seconds


def _range(recording: laboratory.Recording) -> Array:
    every = np.concatenate([log.temperature for log in recording.truth.values()])
    return np.linspace(every.min(), every.max(), POINTS)


def _polyfit(recording: laboratory.Recording) -> tuple[float, ...]:
    at = _range(recording)
    kelvin, readings = [], []
    for log, truth in recording.truth.items():
        records = recording.records[log]
        for name, rows in truth.rows.items():
            if name.endswith(ATTITUDE):
                own = slice(rows.start, rows.stop)
                kelvin.append(records.temperature[own])
                readings.append(records.counts[own] * records.units)
    start = time.process_time()
    middle = REFERENCE + ICE_POINT
    powers = np.polyfit(np.concatenate(kelvin) - middle, np.concatenate(readings), 3)
    change = np.vander(at - middle, 4)[:, :3] @ powers[:3]
    return _judged(at, change, None, time.process_time() - start)


def _own(recording: laboratory.Recording) -> tuple[float, ...]:
    at = _range(recording)
    start = time.process_time()
    tables = chain.in_memory(recording, "diagnosis", BESIDE)
    seconds = time.process_time() - start
    curves = tables["diagnosis/temperature_curves"]
    change, sigma = np.zeros((2, len(at), 6))
    for i, (sensor, axis) in enumerate((s, a) for s in ("accel", "gyro") for a in "xyz"):
        own = curves[(curves["sensor"] == sensor) & (curves["parameter"] == f"bias_{axis}")]
        if len(own):
            own = own.sort_values("temperature")
            for made, key in ((change, "value"), (sigma, "sigma")):
                made[:, i] = np.interp(at, own["temperature"], own[key])
    return _judged(at, change, sigma, seconds)
