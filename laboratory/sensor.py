"""What the IMU makes of the truth: reading = M · truth + bias, and whatever its effects add."""

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

    def feels(self, truth: Array) -> Array:
        """M · truth, (…, 3): what each sensor has along its own axis, scale factor included."""
        return truth @ self.matrix.T


@dataclass(frozen=True)
class Sensors:
    """The accelerometers and the gyros of one IMU."""

    accelerometer: Triad
    gyro: Triad


@dataclass(frozen=True)
class Reading:
    """What the six sensors read, or what one cause adds to it; any number of rows, sensor axes."""

    accelerometer: Array  # (…, 3)
    gyro: Array  # (…, 3)

    @classmethod
    def of_gyros(cls, added: Array) -> Self:
        """Nothing but what the gyros read."""
        return cls(np.zeros_like(added), added)

    @classmethod
    def of_accelerometers(cls, added: Array) -> Self:
        """Nothing but what the accelerometers read."""
        return cls(added, np.zeros_like(added))

    def __add__(self, other: "Reading") -> "Reading":
        return Reading(self.accelerometer + other.accelerometer, self.gyro + other.gyro)


def nothing(rows: int) -> Reading:
    """The reading that adds nothing."""
    return Reading(*np.zeros((2, rows, 3)))


def read(sensors: Sensors, truth: Truth, added: Reading) -> Reading:
    """Increments of a noiseless IMU over every sample, (n, 3) m/s and (n, 3) rad.

    `added` is what effects add to the reading at the instants, (m, 3) m/s² and (m, 3) rad/s.
    The linear part goes by the exact integrals of the truth, only the rest by quadrature.
    """
    instants = truth.motion.instants
    accelerometer, gyro = sensors.accelerometer, sensors.gyro
    return Reading(
        accelerometer.feels(truth.velocity)
        + instants.integral(accelerometer.bias + added.accelerometer),
        gyro.feels(truth.turned) + instants.integral(gyro.bias + added.gyro),
    )
