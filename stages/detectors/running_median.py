"""The running median, which takes no notice of ramps, steps and single readings far off."""

import numpy as np

from stages.detectors.detector import Array

WIDTH = 9  # readings: of these a spike may be up to four


def running_median(values: Array) -> Array:
    """The median of each reading and the four on either side of it, (n,) of (n,), n ≥ 5.

    The ends are continued by turning them about their last reading, which keeps a slope; that
    reading is its own median. Median of nine by three sorted threes: Paeth, Graphics Gems I
    (1990) 171.
    """
    x = np.pad(values, WIDTH // 2, mode="reflect", reflect_type="odd")
    low, high = np.minimum(x[:-2], x[1:-1]), np.maximum(x[:-2], x[1:-1])
    least, most = np.minimum(low, x[2:]), np.maximum(high, x[2:])
    middle = np.maximum(low, np.minimum(high, x[2:]))
    highest_low = np.maximum(np.maximum(least[:-6], least[3:-3]), least[6:])
    lowest_high = np.minimum(np.minimum(most[:-6], most[3:-3]), most[6:])
    return _middle(highest_low, _middle(middle[:-6], middle[3:-3], middle[6:]), lowest_high)


def _middle(a: Array, b: Array, c: Array) -> Array:
    """The middle one of three."""
    return np.maximum(np.minimum(a, b), np.minimum(np.maximum(a, b), c))
