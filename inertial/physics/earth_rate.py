"""The known part of the earth's rate in the truth."""

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import Truth
from inertial.physics.motion import Motion

Array = NDArray[np.float64]


def known_earth(truth: Truth, motion: Motion) -> tuple[Array, Array]:
    """Its upward and its horizontal component in body axes, (n, 3) each, rad/s.

    The horizontal component is zero where the azimuth is not surveyed: there the gyros estimate it
    themselves, and the estimate absorbs any effect on it.
    """
    earth = truth.rate - motion.omega
    upward = np.sum(earth * motion.up, axis=1, keepdims=True) * motion.up
    return upward, np.where(motion.surveyed[:, None], earth - upward, 0.0)
