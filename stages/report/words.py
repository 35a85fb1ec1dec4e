"""Names of sensors, mounts and counts, and how they stand in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

from inertial.text.numbers import shortened

SENSOR = {"gyro": "gyro", "accel": "accelerometer"}
SENSORS = {"gyro": "gyros", "accel": "accelerometers"}
SENSOR_OF_STAGE = {"accelerometer": "Accelerometer", "gyroscope": "Gyroscope"}
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names as part of a sentence: a, b and c."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}"


def capital(text: str) -> str:
    """A sentence with its first letter large."""
    return text[:1].upper() + text[1:]


def with_mount(name: str, mount: str | None) -> str:
    """A name with the mount it is of, where there are several."""
    return f"{name} (mount {shortened(mount, 60)})" if mount else name


def count_in_words(count: int) -> str:
    """A small count as a word."""
    return COUNTS[count] if count < len(COUNTS) else str(count)


def sensor_of_stage(stage: str) -> str:
    """The sensor that a stage estimates."""
    return SENSOR_OF_STAGE.get(stage, stage)


def plain(parameter: str) -> str:
    """bias_x as it is read: bias x."""
    return parameter.replace("_", " ")
