"""Free inertial navigation over minutes, in axes fixed to the earth where it starts.

With C from the case to axes east, north, up at the start, and r the position from there,

    Ċ = C [ω×] − [ω_e×] C        v̇ = C f + g(r) − 2 ω_e × v        ṙ = v
    g(r) = −g u + (g / R) (2 u uᵀ − (I − u uᵀ)) r

u up, R the radius of the earth: gravity turns and grows weaker with the distance, so that the
errors oscillate level with the period of Schuler, 84 min, and grow upright (Titterton & Weston,
Strapdown Inertial Navigation Technology, 2nd ed. 2004, chapters 3 and 12). Terms of second order in
r / R are left out: 10⁻⁶ at 6 km.
"""

from dataclasses import dataclass

import numba
import numpy as np

from inertial.arrays import Array, Integers
from inertial.physics.forward import Site
from inertial.physics.motion import cross, level_axes

EARTH_RADIUS = 6371e3  # m, mean


@dataclass(frozen=True)
class Start:
    """The attitude at the start, (3, 3), case to east, north, up, and the earth's rate there, (3,).

    Where the azimuth is not known, north is any level direction and the earth's rate upright alone.
    """

    attitude: Array
    earth: Array


def aligned(force: Array, rate: Array, site: Site, north: Array | None, compass: bool) -> Start:
    """The attitude at rest: level by the mean specific force, the azimuth in one of three ways.

    Parameters
    ----------
    force, rate : (3,), m/s² and rad/s, means of the corrected readings at rest
    north : (3,), body axes, where it is known
    compass : where it is not, by the level part of the rate; else it stays unknown
    """
    up = force / np.linalg.norm(force)
    known = north is not None or compass
    direction = north if north is not None else rate if compass else level_axes(up)[0]
    level = direction - up * (up @ direction)
    level = level / np.linalg.norm(level)
    attitude = np.array([cross(level, up), level, up])
    return Start(attitude, np.array([0.0, site.earth_level if known else 0.0, site.earth_up]))


@dataclass(frozen=True)
class Course:
    """Attitude, (k, 3, 3), velocity, m/s, and position, m, (k, 3), after some of the samples."""

    attitude: Array
    velocity: Array
    position: Array


def navigated(
    rate: Array, force: Array, step: float, start: Start, gravity: float, after: Integers
) -> Course:
    """Where n samples lead from rest.

    Parameters
    ----------
    rate, force : (n, 3), corrected, rad/s and m/s²; each stands for `step`, s
    after : (k,), ascending, from 0 to n: the number of samples after which the state is wanted
    """
    states = np.empty((len(after), 15))
    _integrate(
        np.ascontiguousarray(rate) * step,
        np.ascontiguousarray(force) * step,
        step,
        np.ascontiguousarray(start.attitude),
        start.earth,
        gravity,
        np.asarray(after, np.int64),
        states,
    )
    return Course(states[:, :9].reshape(-1, 3, 3), states[:, 9:12], states[:, 12:])


@numba.njit(cache=True, nogil=True)
def _rotation(vector: Array, result: Array) -> None:
    """The matrix of a rotation vector, rad."""
    x, y, z = vector
    square = x * x + y * y + z * z
    if square < 1e-8:
        first, second = 1 - square / 6, 0.5 - square / 24
    else:
        angle = np.sqrt(square)
        first, second = np.sin(angle) / angle, (1 - np.cos(angle)) / square
    result[0, 0], result[1, 1], result[2, 2] = (
        1 - second * (y * y + z * z),
        1 - second * (x * x + z * z),
        1 - second * (x * x + y * y),
    )
    result[0, 1], result[1, 0] = second * x * y - first * z, second * x * y + first * z
    result[0, 2], result[2, 0] = second * x * z + first * y, second * x * z - first * y
    result[1, 2], result[2, 1] = second * y * z - first * x, second * y * z + first * x


@numba.njit(cache=True, nogil=True)
def _multiply(one: Array, other: Array, result: Array) -> None:
    for i in range(3):
        for j in range(3):
            result[i, j] = (
                one[i, 0] * other[0, j] + one[i, 1] * other[1, j] + one[i, 2] * other[2, j]
            )


@numba.njit(cache=True, nogil=True)
def _integrate(
    angles: Array,
    impulses: Array,
    step: float,
    attitude: Array,
    earth: Array,
    gravity: float,
    after: Integers,
    states: Array,
) -> None:
    """`angles`, `impulses`: (n, 3), of each sample, rad and m/s; `states`: (k, 15), filled."""
    c, between = attitude.copy(), np.empty((3, 3))
    half, back = np.empty((3, 3)), np.empty((3, 3))
    _rotation(-earth * step / 2, back)
    velocity, position, change = np.zeros(3), np.zeros(3), np.empty(3)
    pull = gravity / EARTH_RADIUS
    k = 0
    for i in range(len(angles) + 1):
        while k < len(after) and after[k] == i:
            states[k, :9] = c.copy().reshape(9)
            states[k, 9:12] = velocity
            states[k, 12:] = position
            k += 1
        if i == len(angles):
            break
        _rotation(angles[i] / 2, half)
        _multiply(back, c, between)
        _multiply(between, half, c)  # in the middle of the sample
        for j in range(3):
            felt = c[j, 0] * impulses[i, 0] + c[j, 1] * impulses[i, 1] + c[j, 2] * impulses[i, 2]
            change[j] = felt - pull * position[j] * step
        change[2] += (3 * pull * position[2] - gravity) * step
        change[0] -= 2 * step * (earth[1] * velocity[2] - earth[2] * velocity[1])
        change[1] -= 2 * step * (earth[2] * velocity[0] - earth[0] * velocity[2])
        change[2] -= 2 * step * (earth[0] * velocity[1] - earth[1] * velocity[0])
        for j in range(3):
            position[j] += (velocity[j] + change[j] / 2) * step
            velocity[j] += change[j]
        _multiply(back, c, between)
        _multiply(between, half, c)
