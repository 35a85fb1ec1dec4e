"""What error remains where only a part of a calibration is applied, by its own M and bias.

    remainder = scale · (M · truth + bias − offset) − truth,   sensor by sensor

for a truth of ±1 g, or ±100 °/s, along each axis in turn.
"""

from collections.abc import Iterator
from itertools import product
from math import radians

import numpy as np
from numpy.typing import NDArray

from inertial.tables import AXES
from stages.exporting.calibration import NAMES, Sensors

Array = NDArray[np.float64]

G = 9.80665  # m/s², by definition
# Per triad: the truth, how it is called, and the unit in which the error is told.
PROBES = {
    "accelerometer": (G, "1 g", 1e-3 * G, "mg"),
    "gyroscope": (radians(100), "100 deg/s", radians(1), "deg/s"),
}


def remaining(sensors: Sensors, offset: Array, scale: Array) -> Array:
    """Error of the three sensors for truth + and − along x, y, z, (6, 3); NaN where unknown.

    offset, scale : (3,), what is taken off a reading and what it is then multiplied by
    """
    size, *_ = PROBES[sensors.kind]
    truth = size * np.array([sign * np.eye(3)[axis] for axis, sign in product(range(3), (1, -1))])
    reading = truth @ sensors.matrix.T + sensors.bias
    return np.asarray(scale * (reading - offset) - truth)


def told(sensors: Sensors, offset: Array, scale: Array) -> Iterator[str]:
    """The largest remainder of each sensor in words, one item each."""
    _, probe, unit_size, unit = PROBES[sensors.kind]
    errors = np.abs(remaining(sensors, offset, scale)) / unit_size
    ways = [f"{sign}{probe} along {axis}" for axis, sign in product(AXES, "+-")]
    sensor = "gyro" if sensors.kind == "gyroscope" else sensors.kind
    for i, axis in enumerate(AXES):
        own = errors[:, i]
        if np.isfinite(own).all():
            worst = int(np.argmax(own))
            yield f"- {axis} {sensor}: up to {own[worst]:.3g} {unit}, with {ways[worst]}"
        else:
            missing = [n for n in NAMES if n in sensors.reasons and n.partition("_")[2][0] == axis]
            yield f"- {axis} {sensor}: not known, for {_listed(missing)} not determined"


def cross_terms(sensors: Sensors) -> str:
    """The six elements of M beside the diagonal."""
    pairs = [(i, j) for i, j in product(range(3), repeat=2) if i != j]
    return _numbers([f"M_{AXES[i]}{AXES[j]}" for i, j in pairs], [sensors.matrix[p] for p in pairs])


def scale_errors(sensors: Sensors) -> str:
    """The three scale factor errors M_xx − 1, M_yy − 1, M_zz − 1, in parts per million."""
    return f"{_numbers(list(AXES), list(1e6 * (np.diag(sensors.matrix) - 1)))} ppm"


def biases(sensors: Sensors) -> str:
    """The three biases with their unit."""
    return f"{_numbers(list(AXES), list(sensors.bias))} {sensors.unit}"


def _numbers(names: list[str], values: list[float]) -> str:
    told = (f"{value:+.6g}" if np.isfinite(value) else "unknown" for value in values)
    return ", ".join(f"{name}={value}" for name, value in zip(names, told, strict=True))


def _listed(names: list[str]) -> str:
    return f"{', '.join(names)} {'was' if len(names) == 1 else 'were'}" if names else "it was"
