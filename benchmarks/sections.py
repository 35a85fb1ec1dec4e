"""The samples of the campaign cut into the sections that another program needs.

The cuts are exact, from the true motion. One file, sections.npz, holds for each
section the accelerometers, m/s², and the gyros, °/s, both (n, 3).
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

from benchmarks.campaign import RATE, RESTS, TURNS, log_of
from inertial.arrays import Array
from laboratory import Recording
from laboratory.recording import LogTruth

FORCE = [f"accel_{axis}" for axis in "xyz"]
TURN = [f"gyro_{axis}" for axis in "xyz"]
AROUND = round(0.25 * RATE)  # samples before and after the motion of a turn
MOVING = 1e-3  # rad/s: the earth turns by less


def write(samples: pd.DataFrame, recording: Recording, path: Path, *, earth: bool) -> None:
    """Write the sections; without `earth`, its true rate is subtracted from the gyros."""
    arrays: dict[str, Any] = {}
    for name in (*RESTS, *TURNS):
        truth = recording.truth[log_of(name)]
        log = samples[samples["log"] == log_of(name)]
        # Lines may be missing in the log, so its samples are identified by their time.
        row = np.searchsorted(truth.time, log["time"].to_numpy() - RATE**-1 / 2)
        chosen = np.ones(len(log), bool)
        if name in TURNS:
            moving = np.flatnonzero(np.linalg.norm(truth.rate, axis=1) > MOVING)
            chosen = (row >= moving[0] - AROUND) & (row <= moving[-1] + AROUND)
        turning = log[TURN].to_numpy(np.float64)
        if not earth:
            turning = turning - earth_of(truth, name)[row]
        arrays[f"acc {name}"] = log[FORCE].to_numpy(np.float64)[chosen]
        arrays[f"gyr {name}"] = np.degrees(turning)[chosen]
    np.savez(path, **arrays)


def earth_of(truth: LogTruth, name: str) -> Array:
    """The earth's true rate in the axes of the case, (n, 3), rad/s."""
    if name in RESTS:
        return np.asarray(truth.rate)
    axis = np.eye(3)["xyz".index(name[0])]
    first = truth.rate[0]  # before the turn there is nothing but the earth
    angle = np.cumsum((truth.rate - first) @ axis) / RATE
    # The case turns by the angle, so the earth turns the other way in its axes.
    return np.asarray(Rotation.from_rotvec(-np.outer(angle, axis)).apply(first))
