"""Readers of the parameter files, as the sources of their programs read them."""

from __future__ import annotations

import re

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

G = 9.80665
UNIT = {"mg": G * 1e-3, "deg/s": np.pi / 180}
PROBE = {"accelerometer": G, "gyro": 100 * np.pi / 180}


def qgroundcontrol(text: str) -> dict[str, np.float32]:
    """ParameterManager::readParametersFromStream: five fields between tabs, # is a comment."""
    values = {}
    for line in text.splitlines():
        if not line.startswith("#"):
            vehicle, component, name, value, kind = line.split("\t")
            integer = name.endswith("_ENABLE")
            assert (int(vehicle), int(component), int(kind)) == (1, 1, 6 if integer else 9)
            values[name] = np.float32(value)
    return values


def mavproxy(text: str) -> dict[str, np.float32]:
    """MAVProxy's mavparm.load: a comma is a space, two words in a line, # begins a comment."""
    values = {}
    for line in text.splitlines():
        line = line.strip()
        if line and line[0] != "#":
            name, value = line.replace(",", " ").split()
            values[name] = np.float32(value)
    return values


def corrected(reading: Array, offset: list[np.float32], scale: list[np.float32] | None) -> Array:
    """(reading − offset) × scale, (n, 3), as both autopilots do it."""
    less = reading - np.array(offset, np.float64)
    return less if scale is None else less * np.array(scale, np.float64)


def remaining(text: str, sensor: str) -> Array:
    """The remaining errors by the head of a file, (3,), m/s² or rad/s; NaN where unknown."""
    prose = re.sub(r"\n# ? *", " ", text)
    _, _, statements = prose.partition("Errors that remain because of this")
    errors = []
    for axis in "xyz":
        stated = re.search(rf"- {axis} {sensor}: (?:up to (\S+) (\S+),|not known)", statements)
        assert stated, f"nothing is said of the {axis} {sensor}"
        errors.append(float(stated[1]) * UNIT[stated[2]] if stated[1] else np.nan)
    return np.array(errors)


def probes(sensor: str) -> Array:
    """The truths of which the head of a file speaks, (6, 3)."""
    return PROBE[sensor] * np.vstack([np.eye(3), -np.eye(3)])
