"""Which stretch of a log is which manoeuvre: the best match that keeps the order of both."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ASKEW = np.radians(25)  # how far an IMU may be mounted from the planned direction
ASLANT = np.radians(45)  # and a turn about another axis than the planned one, as by hand
UPRIGHT = 0.9  # share of the planned direction in the axes that are recorded, to tell it
WRONG_WAY = 0.01  # score of a turn against the planned direction


def align(scores: Array) -> list[int | None]:
    """Match rows to columns in ascending order so that the sum of the scores is largest.

    Parameters
    ----------
    scores : (m, n), how well manoeuvre i fits stretch j; 0 or less where it does not

    Returns
    -------
    for each manoeuvre its stretch, or None where it is not found. Stretches may be
    left over: anything may happen between two manoeuvres.
    """
    m, n = scores.shape
    best = np.zeros((m + 1, n + 1))
    for i in range(1, m + 1):
        for j in range(1, n + 1):
            together = (
                best[i - 1, j - 1] + scores[i - 1, j - 1] if scores[i - 1, j - 1] > 0 else -1.0
            )
            best[i, j] = max(best[i - 1, j], best[i, j - 1], together)
    found: list[int | None] = [None] * m
    i, j = m, n
    while i and j:
        if best[i, j] == best[i - 1, j]:
            i -= 1
        elif best[i, j] == best[i, j - 1]:
            j -= 1
        else:
            i, j = i - 1, j - 1
            found[i] = j
    return found


def rest_score(seconds: float, planned: float | None, force: Array, up: Array | None) -> float:
    """How well a stretch at rest fits a planned rest: by its duration and its direction.

    Parameters
    ----------
    force : (3,), m/s², mean specific force, NaN where not recorded
    up : (3,), the planned direction, None where unknown
    """
    if up is not None and not points(force, up):
        return 0.0
    return min(seconds / planned, 1.0) if planned else seconds / (seconds + 1.0)


def points(force: Array, up: Array) -> bool:
    """Whether a specific force, (3,), points up as planned, as far as its axes are recorded."""
    there = np.isfinite(force)
    seen = float(np.linalg.norm(up[there]))
    if seen < UPRIGHT:
        return True  # the axis that would tell is not recorded
    along = float(force[there] @ up[there]) / seen
    return bool(along >= np.cos(ASKEW) * float(np.linalg.norm(force[there])))


def turn_score(turned: Array, about: Array, planned: float | None) -> float:
    """How well a motion fits a planned turn: by its angle, rad, or its rate, rad/s.

    A turn in the wrong direction is still the turn, unless a better one is there; a turn about
    another axis is not.

    Parameters
    ----------
    turned : (3,), angles or rates about the axes of the body, NaN where not recorded
    about : (3,), the planned axis
    """
    own = np.nan_to_num(turned)
    angle = float(own @ about)
    if abs(angle) < np.cos(ASLANT) * float(np.linalg.norm(own)):
        return 0.0
    if planned is None:
        return abs(angle) / (abs(angle) + 0.1)
    ratio = angle / planned
    if ratio < 0:
        return WRONG_WAY if ratio < -0.5 else 0.0
    return max(1.0 - abs(1.0 - ratio), 0.02) if ratio > 0.005 else 0.0
