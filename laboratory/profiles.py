"""Profiles of a rotation of the table: angle, rate and acceleration as functions of time.

A profile is defined at any time; before and after the rotation the table is at rest.
"""

from dataclasses import dataclass
from math import copysign, sqrt
from typing import NamedTuple, Protocol

import numpy as np

from laboratory.arrays import Array


class Course(NamedTuple):
    """Angle (rad), rate (rad/s) and acceleration (rad/s²) of a turning, each (m,)."""

    angle: Array
    rate: Array
    acceleration: Array


class Profile(Protocol):
    """A rotation as a function of time."""

    @property
    def angle(self) -> float:
        """The total angle, rad, signed."""
        ...

    @property
    def steady_rate(self) -> float:
        """The greatest rate, rad/s, as a magnitude."""
        ...

    def course(self, elapsed: Array) -> Course:
        """Angle, rate and acceleration after `elapsed`, (m,), s."""
        ...


@dataclass(frozen=True)
class Standing:
    """The table is at rest."""

    angle: float = 0.0
    steady_rate: float = 0.0

    def course(self, elapsed: Array) -> Course:
        return Course(*np.zeros((3, len(elapsed))))


@dataclass(frozen=True)
class Steady:
    """The table turns at constant rate, from before the log until after it."""

    rate: float  # rad/s, signed
    seconds: float

    @property
    def angle(self) -> float:
        return self.rate * self.seconds

    @property
    def steady_rate(self) -> float:
        return abs(self.rate)

    def course(self, elapsed: Array) -> Course:
        return Course(self.rate * elapsed, np.full(len(elapsed), self.rate), 0 * elapsed)


@dataclass(frozen=True)
class Trapezoid:
    """From rest to rest by a constant acceleration, a steady rate and the same braking.

    The angle is exact at the ends: spin-up r/a, steady A/r − r/a, spin-down r/a. A turn too small
    to reach its rate has no steady part: r = √(A a).
    """

    start: float  # s, when the table begins to turn
    angle: float  # rad, signed
    set_rate: float  # rad/s, magnitude
    set_acceleration: float  # rad/s², magnitude

    @property
    def steady_rate(self) -> float:
        return min(self.set_rate, sqrt(abs(self.angle) * self.set_acceleration))

    @property
    def spin_up(self) -> float:
        """Seconds of spin-up, and of spin-down."""
        return self.steady_rate / self.set_acceleration

    @property
    def seconds(self) -> float:
        """Duration of the turn, without the rests."""
        return abs(self.angle) / self.steady_rate + self.spin_up

    def course(self, elapsed: Array) -> Course:
        sign = copysign(1.0, self.angle)
        since = np.clip(elapsed - self.start, 0.0, self.seconds)
        left = self.seconds - since
        rising, falling = since < self.spin_up, left < self.spin_up
        half = self.set_acceleration / 2
        angle = self.steady_rate * (since - self.spin_up / 2)
        angle = np.where(rising, half * since**2, angle)
        angle = np.where(falling, abs(self.angle) - half * left**2, angle)
        rate = np.minimum(self.steady_rate, self.set_acceleration * np.minimum(since, left))
        moving = (since > 0) & (left > 0)
        acceleration = self.set_acceleration * (rising.astype(float) - falling) * moving
        return Course(sign * angle, sign * rate, sign * acceleration)


@dataclass(frozen=True)
class Change:
    """A smooth change to the next position, within a given time.

    Angle × s(x), s = x³ (10 − 15 x + 6 x²), x = time / seconds.
    """

    angle: float  # rad
    seconds: float

    @property
    def steady_rate(self) -> float:
        return abs(self.angle) * 15 / 8 / self.seconds

    def course(self, elapsed: Array) -> Course:
        share, slope, bend = smooth_step(elapsed / self.seconds)
        return Course(
            self.angle * share,
            self.angle * slope / self.seconds,
            self.angle * bend / self.seconds**2,
        )


def smooth_step(x: Array) -> tuple[Array, Array, Array]:
    """From 0 at x ≤ 0 to 1 at x ≥ 1, twice differentiable: s = x³ (10 − 15 x + 6 x²), s′, s″."""
    x = np.clip(x, 0.0, 1.0)
    value = x**3 * (10 - 15 * x + 6 * x**2)
    slope = 30 * x**2 * (1 - x) ** 2
    bend = 60 * x * (1 - x) * (1 - 2 * x)
    return value, slope, bend
