"""The forward model: what happens to the IMU on the table, and what it should read.

    reading = M · truth + bias, for both triads,   truth: angular rate and specific force

with the earth's rate and gravity in body axes, and one effect after another on the way
from the motion of the table to the reading.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion

Array = NDArray[np.float64]
Values = Mapping[str, Array]  # label of an effect → values of its parameters


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


def sensed(truth: Truth, gyro: Triad, accelerometer: Triad) -> Reading:
    """What the two triads make of the truth, (n, 3) each."""
    return Reading(
        gyro=truth.rate @ gyro.matrix.T + gyro.bias,
        accel=truth.force @ accelerometer.matrix.T + accelerometer.bias,
    )


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
        truth = effect.moves(truth, motion, (values or {})[effect.label])
    reading = sensed(truth, gyro, accelerometer)
    for effect in effects:
        reading = effect.reads(reading, truth, motion, (values or {})[effect.label])
    return reading


def signatures(
    motion: Motion, site: Site, gyro: Triad, accelerometer: Triad, effects: Sequence[Effect]
) -> list[Reading]:
    """How the readings change per unit of each parameter of effects that are absent.

    The derivative is central, about zero. Where an effect is blind, or its trace is not known,
    the readings do not change.

    Returns
    -------
    for each effect gyro and accel, (n, 3, number of parameters) each
    """
    truth = truth_of(motion, site)
    plain = sensed(truth, gyro, accelerometer)

    def reading(effect: Effect, values: Array) -> Reading:
        moved = effect.moves(truth, motion, values)
        before = plain if moved is truth else sensed(moved, gyro, accelerometer)
        return effect.reads(before, moved, motion, values)

    def signature(effect: Effect) -> Reading:
        if (known := effect.signature(motion)) is not None:
            return known
        traces = np.zeros((2, len(motion.rate), 3, len(effect.parameters)))
        for i, parameter in enumerate(effect.parameters if not effect.blind(motion) else ()):
            step = np.zeros(len(effect.parameters))
            step[i] = parameter.typical
            ahead, behind = reading(effect, step), reading(effect, -step)
            traces[0, :, :, i] = (ahead.gyro - behind.gyro) / (2 * parameter.typical)
            traces[1, :, :, i] = (ahead.accel - behind.accel) / (2 * parameter.typical)
        return Reading(*np.nan_to_num(traces, posinf=0.0, neginf=0.0))

    return [signature(effect) for effect in effects]
