"""Directions in the case of the IMU, as the plan writes them: "+x", or three numbers."""

from collections.abc import Sequence

import numpy as np

from laboratory.arrays import Array


def direction(written: str | Sequence[float]) -> Array:
    """The unit vector, (3,), body axes, of "+x" … "-z" or of any non-zero vector."""
    if isinstance(written, str):
        unit = np.zeros(3)
        unit["xyz".index(written[1])] = -1.0 if written[0] == "-" else 1.0
        return unit
    vector = np.asarray(written, dtype=float)
    return vector / float(np.linalg.norm(vector))
