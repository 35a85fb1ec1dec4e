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
    found = {}
    for line in text.splitlines():
        if not line.startswith("#"):
            vehicle, component, name, value, kind = line.split("\t")
            assert (int(vehicle), int(component), int(kind)) == (1, 1, 9)
            found[name] = np.float32(value)
    return found


def mavproxy(text: str) -> dict[str, np.float32]:
    """MAVProxy's mavparm.load: a comma is a space, two words in a line, # begins a comment."""
    found = {}
    for line in text.splitlines():
        line = line.strip()
        if line and line[0] != "#":
            name, value = line.replace(",", " ").split()
            found[name] = np.float32(value)
    return found


def corrected(reading: Array, offset: list[np.float32], scale: list[np.float32] | None) -> Array:
    """(reading − offset) × scale, (n, 3), as both autopilots do it."""
    less = reading - np.array(offset, np.float64)
    return less if scale is None else less * np.array(scale, np.float64)


def stated(text: str, sensor: str) -> Array:
    """The remainders that the head of a file states, (3,), m/s² or rad/s; NaN where not known."""
    prose = re.sub(r"\n# ? *", " ", text)
    _, _, leaves = prose.partition("What this file cannot carry leaves")
    found = []
    for axis in "xyz":
        told = re.search(rf"- {axis} {sensor}: (?:up to (\S+) (\S+),|not known)", leaves)
        assert told, f"nothing is said of the {axis} {sensor}"
        found.append(float(told[1]) * UNIT[told[2]] if told[1] else np.nan)
    return np.array(found)


def probes(sensor: str) -> Array:
    """The truths of which the head of a file speaks, (6, 3)."""
    return PROBE[sensor] * np.vstack([np.eye(3), -np.eye(3)])
