"""Two level directions for many attitudes at once, and directions after many turns."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def all_level_axes(ups: Array) -> Array:
    """`level_axes` of many upward directions (n, 3), (n, 2, 3)."""
    least = np.eye(3)[np.argmin(np.abs(ups), axis=1)]
    first = np.cross(least, ups)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return np.stack([first, np.cross(ups, first)], axis=1)


def all_turned(directions: Array, abouts: Array, angles: Array) -> Array:
    """`turned` of as many directions as axes and angles, (n, 3); angles (n,), rad."""
    turn = Rotation.from_rotvec(-np.asarray(angles)[:, None] * abouts)
    return np.asarray(turn.apply(directions), dtype=np.float64)
