"""Memory of a sensor: the sign of its last large input, and the play of its hysteresis."""

import numpy as np

from laboratory.arrays import Array


def last_sign(values: Array, least: float, before: Array) -> Array:
    """The sign of each column when its magnitude last exceeded `least`, (m, k).

    values: (m, k), one instant after another; before: (k,), the signs before the first.
    """
    rows = np.arange(1, len(values) + 1)[:, None] * (np.abs(values) > least)
    last = np.maximum.accumulate(rows, axis=0)  # 0: not yet
    signs = np.vstack([before, np.sign(values)])
    signs_then: Array = np.take_along_axis(signs, last, axis=0)
    return signs_then


def play(values: Array, width: float, before: float) -> Array:
    """The play operator, (m,): p follows u, (m,), so that |u − p| ≤ width, and else stays.

    before: p before the first. Between two reversals of u it is the nearest to p at the first that
    is within reach of u.
    """
    ways = np.sign(np.diff(values, prepend=values[:1]))
    played = np.empty_like(values)
    for run in np.split(np.arange(len(values)), np.flatnonzero(np.diff(ways)) + 1):
        played[run] = np.clip(before, values[run] - width, values[run] + width)
        before = float(played[run[-1]])
    return played
