"""The true interval of increments, from the specific force at rest, without the stamps.

At rest an increment of a receiver is gravity times the true interval: design study, 41b.
"""

from dataclasses import dataclass

import numpy as np

from inertial.signal.detector import Array, Log, Piece
from inertial.signal.scale_factor import force_at_rest

SIDE_RECORDS = 2000  # records on either side of a change in which the specific force is compared
MEAN_RECORDS = 25  # records of a mean that shows whether the IMU is at rest
MIN_MEANS = 3  # of these means
MAX_REST_RANGE = 0.02  # m/s²: at rest these means keep to it
FORCE_SIGMA = (
    3e-3  # of gravity: uncertainty of the specific force at rest by bias and scale factor, 3 mg
)
MIN_SIGMA = 4.0  # sigma


@dataclass(frozen=True)
class StampEvidence:
    """The change of |f| per record, 1, and its sigma; NaN where the readings do not show it.

    stamps: True where the stamps are off, False where the sampling is, None where either may be.
    """

    stamps: bool | None = None
    change: float = np.nan
    sigma: float = np.nan


def evidence_of_log(log: Log, away: float) -> StampEvidence:
    """Whether the specific force of a log is off gravity because its stamps are off by `away`."""
    if log.recorded_on is None:
        return StampEvidence()  # readings are no increments
    force = force_at_rest(log) / log.given.gravity - 1
    # Made with an interval that is too long, the specific force is too small.
    if abs(away) > FORCE_SIGMA and min(abs(force + away), abs(force)) < abs(away) / 3:
        return StampEvidence(bool(abs(force + away) < abs(force)), force, FORCE_SIGMA)
    return StampEvidence()


def evidence_of_part(piece: Piece, log: Log, start: int, end: int, away: float) -> StampEvidence:
    """Whether the specific force changes at the ends of records [start, end).

    There the interval by the stamps is longer by `away`, relative.
    """
    if log.recorded_on is None:
        return StampEvidence()
    sides = (
        (slice(max(start - SIDE_RECORDS, 0), start), slice(start, min(start + SIDE_RECORDS, end))),
        (slice(end, end + SIDE_RECORDS), slice(max(end - SIDE_RECORDS, start), end)),
    )
    for outside, inside in sides:
        change, sigma = _change(piece.values[outside, :3], piece.values[inside, :3])
        if np.isfinite(change):
            stamps = bool(abs(change) < abs(change - away))
            return StampEvidence(stamps if abs(away) > MIN_SIGMA * sigma else None, change, sigma)
    return StampEvidence()


def _change(before: Array, after: Array) -> tuple[float, float]:
    """The change of |f| from (n, 3) to (m, 3), relative, and its sigma; NaN unless at rest."""
    means, forces = [], []
    for values in (before, after):
        values = values[np.isfinite(values).all(axis=1)]
        k = len(values) // MEAN_RECORDS
        if k < MIN_MEANS:
            return np.nan, np.nan
        means.append(values[: k * MEAN_RECORDS].reshape(k, MEAN_RECORDS, 3).mean(axis=1))
        forces.append(np.linalg.norm(values, axis=1))
    if (np.ptp(np.concatenate(means), axis=0) > MAX_REST_RANGE).any():
        return np.nan, np.nan
    first, last = (float(force.mean()) for force in forces)
    sigmas = [float(force.std()) / np.sqrt(len(force)) for force in forces]
    return last / first - 1, float(np.hypot(*sigmas) / first)
