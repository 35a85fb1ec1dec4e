"""How fast the table really turned, by a gyro whose scale factor a whole angle has given.

    ω_table = (mean rate − b − ω_e sinφ) / (1 + s),   compared with the set rate

S0 asks whether the table's real speed could be off by so much that a window of 180° by time gives
another scale factor than the whole turn: its own plateau rates answer no (table 5-6).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TableSpeed:
    """By what share the real rate exceeds the set rate, run by run, with sigma, (n,) each."""

    excess: Array
    sigma: Array


def table_speed(
    means: Array,
    rates: Array,
    noise: Array,
    scale: tuple[Array, Array],
    offset: tuple[Array, Array],
) -> TableSpeed:
    """The table's rate of n runs.

    Parameters
    ----------
    means : (n,), rad/s, mean rates in the steady part along the axis of the gyro
    rates : (n,), rad/s, set rates, signed
    noise : (n,), rad/s, sigma of the means
    scale : scale factor errors by whole angles, and their sigma, (n,) each
    offset : bias and upward earth rate together, and its sigma, (n,) each, rad/s
    """
    real = (means - offset[0]) / (1 + scale[0])
    sigma = np.hypot(np.hypot(noise, offset[1]) / rates, scale[1])
    return TableSpeed(np.asarray(real / rates - 1), np.asarray(sigma))
