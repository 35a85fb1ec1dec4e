"""What increments tell of the interval in which they were taken, whatever the stamps say.

At rest an increment of a receiver is gravity times the true interval: design study, 41b.
"""

from dataclasses import dataclass

import numpy as np

from inertial.signal.detector import Array, Log, Piece
from inertial.signal.scale_factor import force_at_rest

NEAR = 2000  # records on either side of a change in which the specific force is compared
LENGTH = 25  # records of the means that tell whether it rests
FEWEST = 3  # of these means
STILL = 0.02  # m/s²: at rest these means keep to it
TELLING = 3e-3  # what the specific force at rest tells in spite of bias and scale factor: 3 mg
CERTAIN = 4.0  # sigma


@dataclass(frozen=True)
class Told:
    """The change of |f| per record, 1, and its sigma; NaN where the readings do not tell.

    stamps: True where the stamps are off, False where the sampling is, None where either may be.
    """

    stamps: bool | None = None
    change: float = np.nan
    sigma: float = np.nan


def told_of_log(log: Log, away: float) -> Told:
    """Whether the specific force of a log is off gravity because its stamps are off by `away`."""
    if log.recorded_on is None:
        return Told()  # readings are no increments
    force = force_at_rest(log) / log.given.gravity - 1
    # Made with an interval that is too long, the specific force is too small.
    if abs(away) > TELLING and min(abs(force + away), abs(force)) < abs(away) / 3:
        return Told(bool(abs(force + away) < abs(force)), force, TELLING)
    return Told()


def told_of_part(piece: Piece, log: Log, start: int, end: int, away: float) -> Told:
    """Whether the specific force changes at the ends of records [start, end).

    There the interval by the stamps is longer by `away`, relative.
    """
    if log.recorded_on is None:
        return Told()
    sides = (
        (slice(max(start - NEAR, 0), start), slice(start, min(start + NEAR, end))),
        (slice(end, end + NEAR), slice(max(end - NEAR, start), end)),
    )
    for outside, inside in sides:
        change, sigma = _change(piece.values[outside, :3], piece.values[inside, :3])
        if np.isfinite(change):
            stamps = bool(abs(change) < abs(change - away))
            return Told(stamps if abs(away) > CERTAIN * sigma else None, change, sigma)
    return Told()


def _change(before: Array, after: Array) -> tuple[float, float]:
    """The change of |f| from (n, 3) to (m, 3), relative, and its sigma; NaN unless at rest."""
    means, forces = [], []
    for values in (before, after):
        values = values[np.isfinite(values).all(axis=1)]
        k = len(values) // LENGTH
        if k < FEWEST:
            return np.nan, np.nan
        means.append(values[: k * LENGTH].reshape(k, LENGTH, 3).mean(axis=1))
        forces.append(np.linalg.norm(values, axis=1))
    if (np.ptp(np.concatenate(means), axis=0) > STILL).any():
        return np.nan, np.nan
    first, last = (float(force.mean()) for force in forces)
    sigmas = [float(force.std()) / np.sqrt(len(force)) for force in forces]
    return last / first - 1, float(np.hypot(*sigmas) / first)
