"""Sensor model: reading = M · truth + bias, plus the errors of effects."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from laboratory.arrays import Array
from laboratory.truth import Truth


@dataclass(frozen=True)
class Triad:
    """Three sensors: M "sensor from case", (3, 3), row = sensor; bias, (3,), unit of the reading.

    M = I + S + N, with γ_yx ("the x axis senses the y force") in row x, column y: S0, eq. 3-1.
    """

    matrix: Array
    bias: Array

    def project(self, truth: Array) -> Array:
        """M · truth, (…, 3): the input along the axis of each sensor, scale factor included."""
        return truth @ self.matrix.T


@dataclass(frozen=True)
class Sensors:
    """The accelerometers and the gyros of one IMU."""

    accelerometer: Triad
    gyro: Triad


@dataclass(frozen=True)
class Reading:
    """Readings of the six sensors, or one contribution to them; any number of rows, sensor axes."""

    accelerometer: Array  # (…, 3)
    gyro: Array  # (…, 3)

    @classmethod
    def of_gyros(cls, added: Array) -> Self:
        """A reading of the gyros alone."""
        return cls(np.zeros_like(added), added)

    @classmethod
    def of_accelerometers(cls, added: Array) -> Self:
        """A reading of the accelerometers alone."""
        return cls(added, np.zeros_like(added))

    def __add__(self, other: "Reading") -> "Reading":
        return Reading(self.accelerometer + other.accelerometer, self.gyro + other.gyro)


def zero_reading(rows: int) -> Reading:
    """A reading of zeros."""
    return Reading(*np.zeros((2, rows, 3)))


def read(sensors: Sensors, truth: Truth, added: Reading) -> Reading:
    """Increments of a noiseless IMU over every sample, (n, 3) m/s and (n, 3) rad.

    added: errors of the readings at the instants, (m, 3) m/s² and (m, 3) rad/s. The linear part
    is computed from the exact integrals of the truth, only the rest by quadrature.
    """
    instants = truth.motion.instants
    accelerometer, gyro = sensors.accelerometer, sensors.gyro
    return Reading(
        accelerometer.project(truth.velocity)
        + instants.integral(accelerometer.bias + added.accelerometer),
        gyro.project(truth.turned) + instants.integral(gyro.bias + added.gyro),
    )
