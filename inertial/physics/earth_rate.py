"""The earth's rate in the truth, as far as it is known beforehand."""

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import Truth
from inertial.physics.motion import Motion

Array = NDArray[np.float64]


def known_earth(truth: Truth, motion: Motion) -> tuple[Array, Array]:
    """Its upward and its level part in body axes, (n, 3) each, rad/s.

    The level part is zero where the azimuth is not surveyed: there the gyros tell it
    themselves, and it takes up whatever an effect would make of it.
    """
    earth = truth.rate - motion.omega
    upward = np.sum(earth * motion.up, axis=1, keepdims=True) * motion.up
    return upward, np.where(motion.surveyed[:, None], earth - upward, 0.0)
