"""What others published of the same IMU: the file published.yaml beside campaign.yaml."""

from collections.abc import Iterator

from inertial.campaign.records import Row
from inertial.sensors import FILE_KEYS
from inertial.tables.yaml_file import YamlFile
from inertial.text.parameters import PARTS, SCALE
from inertial.text.units import ARC_SECOND, DEGREE, STANDARD_GRAVITY

SI = {("accelerometer", "bias"): "m/s²", ("gyro", "bias"): "rad/s"}  # all others are ratios
SIZES = {
    "m/s2": 1.0,
    "mGal": 1e-5,
    "g": STANDARD_GRAVITY,
    "mg": STANDARD_GRAVITY * 1e-3,
    "ug": STANDARD_GRAVITY * 1e-6,
    "rad/s": 1.0,
    "deg/s": DEGREE,
    "deg/h": DEGREE / 3600,
    "1": 1.0,
    "%": 1e-2,
    "ppm": 1e-6,
    "rad": 1.0,
    "mrad": 1e-3,
    "urad": 1e-6,
    "deg": DEGREE,
    "arcmin": ARC_SECOND * 60,
    "arcsec": ARC_SECOND,
}


def published_values(file: YamlFile) -> Iterator[Row]:
    """The values in SI, one row each.

    Raises
    ------
    Refusal
        for the first thing in the file that cannot be used
    """
    file.check("published")
    window = file.content.get("gyro_window")
    for sensor, key in FILE_KEYS.items():
        for name, entry in file.content.get(key, {}).items():
            size = SIZES[entry["unit"]] if "unit" in entry else 1.0
            by_time = window if sensor == "gyro" and name in SCALE else None
            yield {
                "sensor": sensor,
                "quantity": name,
                "value": entry["value"] * size,
                "sigma": entry["sigma"] * size if "sigma" in entry else None,
                "unit": SI.get((key, PARTS[name].kind), "1"),
                "source": file.content["source"],
                "window": by_time["degrees"] * DEGREE if by_time else None,
                "samples": _samples(by_time) if by_time else None,
            }


def _samples(window: Row) -> float:
    """How many samples lie in a window: one for each interval."""
    return float(window["degrees"] / window["rate_deg_s"] * window["rate_hz"])
