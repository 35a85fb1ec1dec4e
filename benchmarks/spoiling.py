"""The faults that are added to the campaign."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from benchmarks.campaign import (
    RATE,
    REST_SECONDS,
    RESTS,
    STILL_SECONDS,
    log_of,
    performed,
    tilted,
)
from laboratory import Recording

LOST_SECONDS = 0.2
SPIKES = 50  # in each rest, on each accelerometer
SPIKE = 50.0  # m/s²


def gap(specified: Mapping[str, Any]) -> Recording:
    """0.2 s are missing in the steady part of a turn."""
    line = round((STILL_SECONDS + 15) * RATE)
    lost = {"log": log_of("x-forward"), "line": line, "samples": round(LOST_SECONDS * RATE)}
    return performed({**specified, "faults": [{"lose": lost}]})


def spikes(specified: Mapping[str, Any]) -> Recording:
    """50 readings of each accelerometer in each rest are 50 m/s² too large."""
    chance = np.random.default_rng(specified["seed"])
    faults = []
    for rest in RESTS:
        lines = 1 + chance.choice(round(REST_SECONDS * RATE), SPIKES, replace=False)
        for axis in "xyz":
            spoilt = {"log": log_of(rest), "channel": f"accel_{axis}", "lines": lines.tolist()}
            faults.append({"spikes": {**spoilt, "size_m_s2": SPIKE}})
    return performed({**specified, "faults": faults})


FAULTS: dict[str, Callable[[Mapping[str, Any]], Recording]] = {
    "0.2 s missing in a turn": gap,
    "50 spikes of 50 m/s² a rest": spikes,
    "one rest tilted by 0.1°": tilted,
}
