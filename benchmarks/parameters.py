"""Twelve parameters of a triad of sensors, and their errors in units for display.

M by rows, then the bias: (12,), no unit and m/s² or rad/s.
"""

from collections.abc import Iterable

import numpy as np

from benchmarks.campaign import document
from inertial.arrays import Array, Booleans

PPM = 1e-6
MICRO_G = 9.80665e-6  # m/s²
DEGREE_HOUR = np.radians(1) / 3600  # rad/s

SCALE: Booleans = np.append(np.eye(3, dtype=bool).ravel(), np.zeros(3, bool))
CROSS: Booleans = np.append(~np.eye(3, dtype=bool).ravel(), np.zeros(3, bool))
BIAS: Booleans = ~(SCALE | CROSS)
MATRIX: Booleans = SCALE | CROSS
BIAS_UNIT = {"accelerometer": MICRO_G, "gyroscope": DEGREE_HOUR}
SENSORS = tuple(BIAS_UNIT)
# Heads of tables, with sensor, parts, and the unit of display.
KINDS = [
    (f"{short} {kind}\n{unit}", sensor, parts, size)
    for sensor, short, bias_unit in (("accelerometer", "accel", "µg"), ("gyroscope", "gyro", "°/h"))
    for kind, parts, unit, size in (
        ("scale", SCALE, "ppm", PPM),
        ("cross", CROSS, "ppm", PPM),
        ("bias", BIAS, bias_unit, BIAS_UNIT[sensor]),
    )
]
NAMES = tuple(f"scale_{r}" if r == c else f"cross_{r}{c}" for r in "xyz" for c in "xyz") + tuple(
    f"bias_{r}" for r in "xyz"
)


def truth() -> dict[str, Array]:
    """The true parameters, by sensor."""
    true = document(0)["truth"]
    return {
        "accelerometer": triad(true["accelerometer"]["matrix"], true["accelerometer"]["bias_m_s2"]),
        "gyroscope": triad(true["gyro"]["matrix"], true["gyro"]["bias_rad_s"]),
    }


def triad(matrix: Iterable[Iterable[float]], bias: Iterable[float]) -> Array:
    """M and bias as one vector."""
    return np.append(np.array(list(matrix), float).ravel(), np.array(list(bias), float))


def worst(off: Array, parts: Booleans, unit: float) -> float:
    """The largest of some of the parameters, in a unit; NaN where a method gives none of them."""
    return float(np.fmax.reduce(np.abs(off[parts])) / unit)
