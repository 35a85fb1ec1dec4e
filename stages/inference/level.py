"""Directions after many turns at once."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def all_turned(directions: Array, abouts: Array, angles: Array) -> Array:
    """`turned` of as many directions as axes and angles, (n, 3); angles (n,), rad."""
    turn = Rotation.from_rotvec(-np.asarray(angles)[:, None] * abouts)
    return np.asarray(turn.apply(directions), dtype=np.float64)
