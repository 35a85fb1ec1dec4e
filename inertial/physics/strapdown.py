"""Free inertial navigation over minutes, in axes fixed to the earth where it starts.

With C from the case to axes east, north, up at the start, and r the position from there,

    Ċ = C [ω×] − [ω_e×] C        v̇ = C f + g(r) − 2 ω_e × v        ṙ = v
    g(r) = −g u + (g / R) (2 u uᵀ − (I − u uᵀ)) r

u up, R the radius of the earth: gravity turns and grows weaker with the distance, so that the
errors oscillate level with the period of Schuler, 84 min, and grow upright (Titterton & Weston,
Strapdown Inertial Navigation Technology, 2nd ed. 2004, chapters 3 and 12). Terms of second order in
r / R are left out: 10⁻⁶ at 6 km.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np
from scipy.linalg import block_diag, expm

from inertial.arrays import Array, Integers
from inertial.physics.forward import Site
from inertial.physics.motion import cross, horizontal, level_axes

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
    level = horizontal(direction, up)
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


# ---- How errors of corrected readings grow in free inertial navigation, to first order.
#
# With the attitude as computed turned too far by ψ, and errors δω, δf of the corrected readings,
# all in axes east, north, up of the start (see `strapdown`), in which the true force at rest, and
# of an IMU that turns in place, is g u:
#
#     ψ̇ = δω − ω_e × ψ
#     δv̇ = δf + ψ × g u − 2 ω_e × δv + (g / R) (2 u uᵀ − (I − u uᵀ)) δr        δṙ = δv
#
# (Titterton & Weston 2004, chapter 12; Groves, Principles of GNSS, Inertial, and Multisensor
# Integrated Navigation Systems, 2nd ed. 2013, chapter 14.) It is linear with constant coefficients,
# so a constant error over a step is integrated exactly.

UP = np.array([0.0, 0.0, 1.0])
ATTITUDE, VELOCITY, POSITION = slice(0, 3), slice(3, 6), slice(6, 9)


@dataclass(frozen=True)
class Growth:
    """The growth of errors in steps of `step`, s, under gravity, m/s², on a turning earth, (3,)."""

    gravity: float
    earth: Array
    step: float

    @cached_property
    def dynamics(self) -> Array:
        """Of attitude, velocity and position errors, (9, 9)."""
        f = np.zeros((9, 9))
        f[ATTITUDE, ATTITUDE] = -_skew(self.earth)
        f[VELOCITY, ATTITUDE] = -self.gravity * _skew(UP)
        f[VELOCITY, VELOCITY] = -2 * _skew(self.earth)
        f[VELOCITY, POSITION] = self.gravity / EARTH_RADIUS * np.diag([-1.0, -1.0, 2.0])
        f[POSITION, VELOCITY] = np.eye(3)
        return f

    @cached_property
    def over_a_step(self) -> tuple[Array, Array]:
        """The transition of the errors over a step, (9, 9), and of δω, δf constant, (9, 6)."""
        whole = np.zeros((15, 15))
        whole[:9, :9], whole[:6, 9:] = self.dynamics, np.eye(6)
        moved = expm(whole * self.step)
        return moved[:9, :9], moved[:9, 9:]

    def of(self, errors: Array, start: Array, after: Sequence[int]) -> Array:
        """Errors after some steps, (k, 9, p), by p causes.

        Parameters
        ----------
        errors : (n, 6, p), δω and δf in each step, or (1, 6, p) where they stay the same
        start : (9, p)
        after : (k,), ascending, steps
        """
        transition, response = self.over_a_step
        driven = response @ errors
        state, result = start, []
        for i in range(max(after) + 1):
            result += [state] * list(after).count(i)
            if i < max(after):
                state = transition @ state + driven[min(i, len(driven) - 1)]
        return np.array(result)

    def of_noise(self, attitude: Array, white: Array, walk: Array, after: Sequence[int]) -> Array:
        """Covariance of the errors by noise from the start on, (k, 9, 9).

        Parameters
        ----------
        attitude : (n, 3, 3) or (1, 3, 3), case to the axes of the start, in each step
        white : (6, 6), covariance of the white noise of corrected rates and forces, case, per √s
        walk : (6, 6), of the random walk of their biases from the start on
        after : (k,), ascending, steps
        """
        covariance, result = np.zeros((15, 15)), []
        moved, added = self._noise_of_a_step(attitude[0], white, walk)
        for i in range(max(after) + 1):
            result += [covariance[:9, :9]] * list(after).count(i)
            if i == max(after):
                break
            if 0 < i < len(attitude):
                moved, added = self._noise_of_a_step(attitude[i], white, walk)
            covariance = moved @ covariance @ moved.T + added
        return np.array(result)

    def _noise_of_a_step(self, attitude: Array, white: Array, walk: Array) -> tuple[Array, Array]:
        """The transition of errors and biases over a step, and what noise adds, (15, 15) each.

        By one exponential (Van Loan, IEEE Trans. Autom. Control 23 (1978) 395).
        """
        turn = np.kron(np.eye(2), attitude)
        both = np.zeros((30, 30))
        dynamics = np.zeros((15, 15))
        dynamics[:9, :9], dynamics[:6, 9:] = self.dynamics, turn
        density = block_diag(turn @ white @ turn.T, np.zeros((3, 3)), walk)
        both[:15, :15], both[:15, 15:], both[15:, 15:] = -dynamics, density, dynamics.T
        exponential = expm(both * self.step)
        moved = exponential[15:, 15:].T
        return moved, moved @ exponential[:15, 15:]


def of_alignment(
    force: Array, rate: Array, gravity: float, earth: Array, *, compass: bool
) -> Array:
    """The attitude error of `strapdown.aligned` by errors at rest, (3, p).

    Parameters
    ----------
    force, rate : (3, p), mean errors of the corrected readings in axes east, north, up
    compass : whether the azimuth is that of the level rate; else it is known, or counts as such
    """
    tilt = -cross(UP, force.T).T / gravity
    if compass:
        tilt[2] = (tilt[1] * earth[2] + rate[0]) / earth[1]
    return np.asarray(tilt)


def _skew(vector: Array) -> Array:
    return np.asarray(cross(vector, np.eye(3)).T)
