"""The forward model: what happens to the IMU on the table, and what it should read.

    reading = M · truth + bias, for both triads,   truth: angular rate and specific force

with the earth's rate and gravity in body axes, and one effect after another on the way
from the motion of the table to the reading.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.model.effect import Effect, Reading, Truth
from stages.model.motion import Motion

Array = NDArray[np.float64]
Values = Mapping[str, Array]  # name of an effect → values of its parameters


@dataclass(frozen=True)
class Site:
    """Gravity, m/s², and the earth's rate, rad/s: its upward and its level part."""

    gravity: float
    earth_up: float
    earth_level: float


@dataclass(frozen=True)
class Triad:
    """Three sensors in one case: M (3, 3), and bias (3,)."""

    matrix: Array
    bias: Array


def truth_of(motion: Motion, site: Site) -> Truth:
    """What the sensors would feel of the table, gravity and the earth alone; (n, 3) each."""
    earth = site.earth_up * motion.up + site.earth_level * np.nan_to_num(motion.north)
    return Truth(rate=motion.omega + earth, force=site.gravity * motion.up)


def predict(
    motion: Motion,
    site: Site,
    gyro: Triad,
    accelerometer: Triad,
    effects: Sequence[Effect] = (),
    values: Values | None = None,
) -> Reading:
    """What the IMU should read on this motion, had it all these effects."""
    truth = truth_of(motion, site)
    for effect in effects:
        truth = effect.moves(truth, motion, (values or {})[effect.name])
    reading = Reading(
        gyro=truth.rate @ gyro.matrix.T + gyro.bias,
        accel=truth.force @ accelerometer.matrix.T + accelerometer.bias,
    )
    for effect in effects:
        reading = effect.reads(reading, truth, motion, (values or {})[effect.name])
    return reading


def signature(
    motion: Motion, site: Site, gyro: Triad, accelerometer: Triad, effect: Effect
) -> Reading:
    """How the readings change per unit of each parameter of an effect that is absent.

    The derivative is central, about zero.

    Returns
    -------
    gyro and accel, (n, 3, number of parameters) each
    """

    def reading(values: Array) -> Reading:
        return predict(motion, site, gyro, accelerometer, [effect], {effect.name: values})

    gyros, accels = [], []
    for step in np.diag([parameter.typical for parameter in effect.parameters]):
        ahead, behind = reading(step), reading(-step)
        size = 2 * float(step.sum())
        gyros.append((ahead.gyro - behind.gyro) / size)
        accels.append((ahead.accel - behind.accel) / size)
    return Reading(np.stack(gyros, axis=-1), np.stack(accels, axis=-1))
