"""Smallest error of any unbiased method: the Cramér–Rao bound, from the design.

It knows the white noise, the table's motion and gravity, and uses every sample:

    accelerometers   reading = M g u + b
    gyros            reading = M (u (rate + ω_up) + e) + b

where u points up; the horizontal component e of the earth rate, which rotates while the table
turns, is unknown at each position except for its size. It shares no code with the stages.
"""

from math import cos, radians, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from benchmarks.campaign import (
    FORCE_NOISE,
    RATE,
    REST_SECONDS,
    RESTS,
    STILL_SECONDS,
    TURN_DEGREES,
    TURN_NOISE,
    TURN_RATE,
    TURNS,
    document,
)
from inertial.arrays import Array

EARTH_RATE = 7.292115e-5  # rad/s, WGS 84
DRAWS = 20000
STEPS = 72  # of a turn


def accelerometers() -> Array:
    """Covariance of M by rows and b (m/s²), (12, 12)."""
    gravity = document(0)["campaign"]["site"]["gravity_m_s2"]
    information = np.zeros((4, 4))
    turning = TURN_DEGREES / TURN_RATE + 1 + 2 * STILL_SECONDS  # its ramps last 1 s each
    ups = [(up, REST_SECONDS) for up in RESTS.values()]
    ups += [(up, turning) for up, _ in TURNS.values()]
    for up, seconds in ups:
        row = np.append(gravity * unit(up), 1.0)
        information += np.outer(row, row) * seconds * RATE / FORCE_NOISE**2
    return _of_triad(np.asarray(np.linalg.inv(information), np.float64))


def gyros() -> Array:
    """Covariance of M by rows and b (rad/s), (12, 12)."""
    latitude = radians(document(0)["campaign"]["site"]["latitude_deg"])
    earth_up, earth_level = EARTH_RATE * sin(latitude), EARTH_RATE * cos(latitude)
    density = radians(TURN_NOISE) / sqrt(RATE)
    rows, positions = 12, len(RESTS) + len(TURNS)
    information = np.zeros((rows + 2 * positions,) * 2)
    information[rows:, rows:] = np.eye(2 * positions) * 2 / earth_level**2

    def see(up: Array, rate: float, seconds: float, position: int, angle: float = 0.0) -> None:
        first, second = np.eye(3)[up == 0]
        level = rows + 2 * position
        design = np.zeros((3, len(information)))
        design[:, :9] = np.kron(np.eye(3), up * (rate + earth_up))
        design[:, 9:rows] = np.eye(3)
        design[:, level] = cos(angle) * first + sin(angle) * second
        design[:, level + 1] = cos(angle) * second - sin(angle) * first
        information[:] += design.T @ design * seconds / density**2

    for number, direction in enumerate(RESTS.values()):
        up = unit(direction)
        see(up, 0.0, REST_SECONDS, number)
    for number, (direction, sign) in enumerate(TURNS.values(), len(RESTS)):
        up, seconds = unit(direction), TURN_DEGREES / TURN_RATE + 1
        see(up, 0.0, 2 * STILL_SECONDS, number)
        for angle in np.linspace(0, radians(TURN_DEGREES), STEPS, endpoint=False):
            see(up, sign * radians(TURN_DEGREES) / seconds, seconds / STEPS, number, angle)
    return np.asarray(np.linalg.inv(information)[:rows, :rows])


def unit(direction: str) -> Array:
    """The vector of +x, −x, +y …"""
    sign = 1.0 if direction[0] == "+" else -1.0
    return np.asarray(sign * np.eye(3)["xyz".index(direction[1])])


def expected_worst(covariance: Array, parts: NDArray[np.bool_]) -> float:
    """Mean of the largest error of some parameters, by their covariance."""
    chosen = covariance[np.ix_(parts, parts)]
    drawn = np.random.default_rng(0).multivariate_normal(np.zeros(len(chosen)), chosen, DRAWS)
    return float(np.abs(drawn).max(axis=1).mean())


def _of_triad(of_channel: Array) -> Array:
    """The covariance of three equal and independent channels, each of a row of M and a bias."""
    covariance = np.zeros((12, 12))
    for row in range(3):
        places = [3 * row, 3 * row + 1, 3 * row + 2, 9 + row]
        covariance[np.ix_(places, places)] = of_channel
    return covariance
