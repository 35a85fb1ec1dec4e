"""Memory of a sensor: the sign of its last large input."""

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
