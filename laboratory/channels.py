"""The six channels of an IMU, by name and by column."""

from collections.abc import Mapping
from typing import Any, Final

CHANNELS: Final = ("accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z")
SENSORS: Final = {"accelerometer": "accel", "gyro": "gyro"}  # as written → in a channel's name
UNITS: Final = {"accel": "m_s2", "gyro": "rad_s"}  # at the end of a key


def column(channel: str) -> int:
    """The column of a channel, 0 … 5."""
    return CHANNELS.index(channel)


def column_of(sensor: str, axis: str) -> int:
    """The column of "accelerometer" or "gyro" along "x", "y" or "z", 0 … 5."""
    return column(f"{SENSORS[sensor]}_{axis}")


def in_its_unit(parameters: Mapping[str, Any], word: str) -> float:
    """The value of `word` for the channel, m/s² or rad/s: its key ends with the unit."""
    sensor = str(parameters["channel"]).partition("_")[0]
    return float(parameters[f"{word}_{UNITS[sensor]}"])
