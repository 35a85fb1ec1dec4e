"""The arrays of numpy by what they hold, and a number of one as tables have it."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Integers = NDArray[np.int64]


def finite_or_none(value: float) -> float | None:
    """A number as tables have it: none where it is NaN or infinite."""
    return float(value) if np.isfinite(value) else None
