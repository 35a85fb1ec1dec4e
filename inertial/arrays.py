"""The arrays of numpy by what they hold; a number of one as tables have it, an axis of a vector."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]


def finite_or_none(value: float) -> float | None:
    """A number as tables have it: none where it is NaN or infinite."""
    return float(value) if np.isfinite(value) else None


def nearest_axis(vector: Array | Sequence[float]) -> int:
    """The axis, 0, 1 or 2, to which a vector, (3,), is nearest, either way."""
    return int(np.argmax(np.abs(vector)))
