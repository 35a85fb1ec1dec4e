"""The calibration as one document of plain values, the same for JSON and YAML.

`calibration.schema.json` beside this file says what every key means and in which unit. Whoever
changes a key, or what it means, counts VERSION up there and here.
"""

from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.records import Row
from stages.exporting.calibration import NAMES, Calibration, Mount, Sensors
from stages.exporting.worked import Worked

Array = NDArray[np.float64]

FORMAT = "turntable calibration"
VERSION = 2
SQRT_HZ = {"accel": "(m/s²)/√Hz", "gyro": "(rad/s)/√Hz"}
EQUATION = {
    "reading": "reading = M · truth + bias",
    "correction": "truth = inverse · (reading − bias), with inverse = M⁻¹",
    "in_words": "Take the bias off the three readings, then multiply by the inverse: row i of it"
    " times the three differences gives the truth along axis i. All nine elements are meant, not"
    " the diagonal alone. Readings are those of the log in m/s² and rad/s, with the count size that"
    " the campaign states.",
    "matrix": "Row: the sensor that reads, x y z. Column: the axis that it feels, x y z."
    " scale_x is M_xx − 1, cross_xy is M_xy.",
    "signs": "Specific force: the axis that points up reads +g at rest. Angular rate: right-hand"
    " rule; it contains the earth's rate, so a corrected gyro at rest reads that and not zero.",
    "frame": "Body axes x, y, z of the IMU, right-handed, as its data sheet names them and as the"
    " campaign set them on the table. No axis is exchanged or turned over.",
}


def document(calibration: Calibration) -> Row:
    """The content of calibration.json and calibration.yaml."""
    about = calibration.about
    texts = ("instrument", "serial", "date", "laboratory", "operator", "notes", "table")
    return {
        "format": FORMAT,
        "version": VERSION,
        "campaign": about["campaign"],
        "simulated": bool(about["simulated"]),
        "not_exported": calibration.nothing,
        **{key: about[key] for key in texts},
        "equation": EQUATION,
        "mounts": [_mount(mount) for mount in calibration.mounts],
        "noise": [_noise(row) for row in calibration.noise],
        "rate": {
            "unit": "Hz",
            "measured": _number(calibration.rate),
            "stated": _number(about["rate"]),
        },
        "temperature": calibration.temperature and {"unit": "K", **calibration.temperature},
        "known": [
            {
                "quantity": row["quantity"],
                "value": _number(row["value"]),
                "sigma": _number(row["sigma"]),
                "unit": row["unit"],
                "origin": row["origin"],
            }
            for row in calibration.known
        ],
        "inputs": [
            {key: row[key] for key in ("file", "size", "sha256")} for row in calibration.inputs
        ],
        "made_by": list(calibration.made_by),
    }


def _mount(mount: Mount) -> Row:
    return {
        "mount": mount.name,
        "accelerometer": _sensors(mount.accelerometer),
        "gyroscope": _sensors(mount.gyroscope),
        "worked_samples": [_worked(each, mount) for each in mount.worked],
    }


def _sensors(sensors: Sensors) -> Row:
    return {
        "result": "extended" if sensors.effects else "joint",
        "effects": [
            {
                "name": row["parameter"],
                "value": _number(row["value"]),
                "sigma": _number(row["sigma"]),
                "unit": row["unit"],
                "meaning": row["meaning"],
            }
            for row in sensors.effects
        ],
        "matrix": {
            "unit": "1",
            "value": _numbers(sensors.matrix),
            "sigma": _numbers(sensors.matrix_sigma),
        },
        "inverse": {
            "unit": "1",
            "value": _numbers(sensors.inverse),
            "sigma": _numbers(sensors.inverse_sigma),
        },
        "bias": {
            "unit": sensors.unit,
            "value": _numbers(sensors.bias),
            "sigma": _numbers(sensors.bias_sigma),
        },
        "covariance": {"names": list(sensors.names), "value": _numbers(sensors.covariance)},
        "not_determined": [
            {"name": f"{sensors.stem}/{name}", "reason": reason}
            for name in (*NAMES, "inverse")
            if (reason := sensors.no_inverse if name == "inverse" else sensors.reasons.get(name))
        ],
        "fit": sensors.fit and _fit(sensors.fit),
    }


def _fit(row: Row) -> Row:
    return {
        "chi_squared": _number(row["chi_squared"]),
        "degrees": row["degrees"],
        "p_value": _number(row["p_value"]),
        "scatter": _number(row["scatter"]),
        "unit": row["unit"],
        "used": row["used"],
        "left_out": row["left_out"],
    }


def _worked(sample: Worked, mount: Mount) -> Row:
    def tried(sensors: Sensors, reading: Array) -> Row:
        return {
            "unit": sensors.unit,
            "reading": _numbers(reading),
            "corrected": _numbers(sensors.truth(reading)),
        }

    return {
        "what": sample.what,
        "manoeuvre": sample.manoeuvre,
        "log": sample.log,
        "from_record": sample.first,
        "to_record": sample.after,
        "line": sample.line,
        "accelerometer": tried(mount.accelerometer, sample.reading[:3]),
        "gyroscope": tried(mount.gyroscope, sample.reading[3:]),
    }


def _noise(row: Row) -> Row:
    numbers = ("density", "least", "most", "data_sheet")
    return {
        "channel": row["channel"],
        "unit": SQRT_HZ[row["channel"].partition("_")[0]],
        **{key: _number(row[key]) for key in numbers},
        "stretches": row["stretches"],
    }


def _numbers(array: Array | None) -> Any:
    """Nested lists of an array, null for what is NaN; null for no array."""
    if array is None:
        return None
    return [_number(each) if np.ndim(each) == 0 else _numbers(each) for each in array]


def _number(value: float | None) -> float | None:
    return None if value is None or not isfinite(value) else float(value)
