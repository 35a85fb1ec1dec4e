"""Which stretch of a log is which manoeuvre: the best match that keeps the order of both."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
    along = np.nan if up is None else float(force @ up)
    if along < np.cos(np.radians(25)) * np.linalg.norm(force):
        return 0.0
    return min(seconds / planned, 1.0) if planned else seconds / (seconds + 1.0)


def turn_score(angle: float, planned: float | None) -> float:
    """How well a motion fits a planned turn: by its angle about the axis, rad.

    A turn in the wrong direction is still the turn, unless a better one is there.
    """
    if planned is None:
        return abs(angle) / (abs(angle) + 0.1)
    ratio = angle / planned
    if ratio < 0:
        return 0.01 if ratio < -0.5 else 0.0
    return max(1.0 - abs(1.0 - ratio), 0.02) if ratio > 0.005 else 0.0
