"""A log of columns of text: a line with their names, then one line of numbers per sample.

    time,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z,temperature
    0.010000000,12,-3,704,5,-2,64184,23.417

Time in s since the campaign's first sample, counts of the increments, temperature in °C; where the
encoder is recorded a last column, table_angle, in degrees.
"""

from typing import Any, Final

import numpy as np

from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records
from laboratory.units import ICE_POINT

GYRO: Final = ["gyro_x", "gyro_y", "gyro_z"]
ACCELEROMETER: Final = ["accel_x", "accel_y", "accel_z"]
NAMES: Final = ["time", *GYRO, *ACCELEROMETER, "temperature"]
ANGLE: Final = "table_angle"
LINE: Final = "%s%d.%09d" + ",%d" * 6 + ",%.3f"


def log_bytes(records: Records, start: int, line_end: bytes) -> bytes:
    """The whole log; start: the campaign's first sample, ns since the start of GPS time."""
    end, angle = line_end.decode("ascii"), records.table_angle
    line, names = LINE, NAMES
    since = records.stamps - start
    signs = ["-" if time < 0 else "" for time in since.tolist()]
    seconds, fraction = divmod(abs(since), NANOSECONDS)
    fields = [
        signs,
        seconds.tolist(),
        fraction.tolist(),
        *records.counts[:, [3, 4, 5, 0, 1, 2]].T.tolist(),
        (records.temperature - ICE_POINT).tolist(),
    ]
    if angle is not None:
        fields.append(np.degrees(angle).tolist())
        line, names = LINE + ",%.7f", [*NAMES, ANGLE]
    lines = [line % values + end for values in zip(*fields, strict=True)]
    return (",".join(names) + end + "".join(lines)).encode("ascii")


def layout(counts_per_rad_s: float, counts_per_m_s2: float, encoder: bool) -> dict[str, Any]:
    """The format by which a campaign file describes such a log."""
    angle = {"table_angle": {"column": ANGLE, "unit": "deg"}} if encoder else {}
    return {
        "kind": "columns",
        "delimiter": ",",
        "header_lines": 1,
        "time": {"column": "time", "unit": "s"},
        "temperature": {"column": "temperature", "unit": "degC"},
        **angle,
        "gyro": {"columns": GYRO, "unit": "rad/s", "counts_per_unit": counts_per_rad_s},
        "accelerometer": {
            "columns": ACCELEROMETER,
            "unit": "m/s2",
            "counts_per_unit": counts_per_m_s2,
        },
    }
