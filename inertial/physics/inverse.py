"""The inverse of the forward model: specific force and angular rate from readings.

    truth = M⁻¹ (reading − bias − effects(truth))                 (S0, compensation; effects added)

Effects are small, so the equation is solved by inserting its result into it again.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.forward import Triad
from inertial.physics.motion import Motion

Array = NDArray[np.float64]
Sized = tuple[Effect, Array]  # an effect with the values of its parameters

MAX_ROUNDS = 20  # in which effects of one part in two are taken out to one in a million
MAX_RELATIVE_CHANGE = 1e-12  # of the truth in the last round


def force_of(
    reading: Array, accelerometer: Triad | None, effects: Sequence[Sized], motion: Motion
) -> Array:
    """Specific force from the readings of accelerometers, (n, 3); NaN where it is not known."""
    nothing = np.zeros_like(reading)

    def added(force: Array) -> Array:
        truth = Truth(nothing, force)
        return sum(
            (e.reads(Reading(nothing, nothing), truth, motion, v).accel for e, v in effects),
            nothing,
        )

    return _truth(reading, accelerometer, added if effects else None)


def rate_of(
    reading: Array, gyro: Triad | None, effects: Sequence[Sized], motion: Motion, force: Array
) -> Array:
    """Angular rate from the readings of gyros and the specific force that they feel, (n, 3)."""
    nothing = np.zeros_like(reading)

    def added(rate: Array) -> Array:
        truth = Truth(rate, force)
        return sum(
            (e.reads(Reading(nothing, nothing), truth, motion, v).gyro for e, v in effects),
            nothing,
        )

    return _truth(reading, gyro, added if effects else None)


def _truth(reading: Array, triad: Triad | None, added: Callable[[Array], Array] | None) -> Array:
    """The truth of three sensors, of which one that is not recorded leaves none."""
    if triad is None:
        return np.full(reading.shape, np.nan)
    inverse = np.linalg.inv(triad.matrix).T
    plain = reading - triad.bias
    truth = np.asarray(plain @ inverse)
    if added is None:
        return truth
    for _unused in range(MAX_ROUNDS):
        before, truth = truth, np.asarray((plain - added(truth)) @ inverse)
        change = np.linalg.norm(truth - before, axis=1)
        unsettled = change > MAX_RELATIVE_CHANGE * np.linalg.norm(truth, axis=1)
        if not unsettled.any():
            break
    truth[unsettled] = np.nan  # an effect as large as the reading
    return truth
