"""How a turntable moves, and what is up for the IMU on it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def turned(direction: Array, about: Array, angle: float) -> Array:
    """A direction of the laboratory as the IMU sees it after it has turned by `angle`.

    `direction` and `about` are body vectors before the turn. The IMU turns about
    `about` by the right-hand rule, so what stands still in the laboratory turns the
    other way in body axes.
    """
    return np.asarray(Rotation.from_rotvec(-angle * about).apply(direction), dtype=np.float64)


def level_axes(up: Array) -> tuple[Array, Array]:
    """Two level directions in body axes that make, with `up`, a right-handed triad."""
    least = np.eye(3)[np.argmin(np.abs(up))]
    first = np.cross(least, up)
    first /= np.linalg.norm(first)
    return first, np.cross(up, first)


@dataclass(frozen=True)
class Profile:
    """A turn with constant acceleration at its start and stop: a trapezoid of the rate.

    `angle` (rad) and `rate` (rad/s) are magnitudes; `acceleration` in rad/s².
    """

    angle: float
    rate: float
    acceleration: float

    @property
    def ramp_seconds(self) -> float:
        """Duration of the acceleration, and of the braking, s."""
        return self.rate / self.acceleration

    @property
    def seconds(self) -> float:
        """From start to stop, A/r + r/a, s."""
        return self.angle / self.rate + self.ramp_seconds

    def at(self, time: Array) -> tuple[Array, Array]:
        """Angle, rad, and rate, rad/s, at times since the start, (n,) each; still outside."""
        t = np.clip(time, 0.0, self.seconds)
        ramp, left = self.ramp_seconds, self.seconds - t
        up = self.acceleration * t**2 / 2
        steady = self.rate * (t - ramp / 2)
        down = self.angle - self.acceleration * left**2 / 2
        angle = np.where(t < ramp, up, np.where(left < ramp, down, steady))
        rate = np.minimum(self.rate, self.acceleration * np.minimum(t, left))
        return angle, rate


@dataclass(frozen=True)
class Motion:
    """What the table does to the IMU in n stretches of time, samples or blocks; body axes.

    `time`: (n,), s since the campaign's start, NaN where the logs have no common clock;
    `about`: (3,), axis of the turn; `angle`, `rate`, `acceleration`: (n,), rad, rad/s, rad/s²,
    turned about it since the start, at the middle of each stretch; `up`: (n, 3), the table's
    vertical; `north`: (n, 3), NaN where the azimuth is not known.
    """

    time: Array
    about: Array
    angle: Array
    rate: Array
    acceleration: Array
    up: Array
    north: Array

    @property
    def omega(self) -> Array:
        """Rate of the table as a vector, (n, 3), rad/s."""
        return np.outer(self.rate, self.about)

    @property
    def alpha(self) -> Array:
        """Angular acceleration of the table as a vector, (n, 3), rad/s²."""
        return np.outer(self.acceleration, self.about)


def turned_all(direction: Array, about: Array, angles: Array) -> Array:
    """`turned` for many angles at once, (n, 3), by Rodrigues' formula."""
    along = about * (about @ direction)
    across = np.outer(np.cos(angles), direction - along)
    return np.asarray(along + across - np.outer(np.sin(angles), np.cross(about, direction)))
