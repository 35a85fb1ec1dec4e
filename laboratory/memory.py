"""Memory of a sensor: play and relay, of which hysteresis is made."""

import numpy as np

from laboratory.arrays import Array


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


def relay(values: Array, width: float, before: float) -> Array:
    """The relay operator, (m,): 1 once u, (m,), is above `width`, −1 once it is below −`width`.

    before: what it was before the first, which it keeps until then.
    """
    flips = np.where(np.abs(values) > width, np.sign(values), 0.0)
    flips = np.concatenate([[before], flips])
    places = np.where(flips != 0, np.arange(len(flips)), 0)
    return flips[np.maximum.accumulate(places)][1:]
