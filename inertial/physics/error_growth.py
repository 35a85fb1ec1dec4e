"""How errors of corrected readings grow in free inertial navigation, to first order.

With the attitude as computed turned too far by ψ, and errors δω, δf of the corrected readings, all
in axes east, north, up of the start (see `strapdown`), in which the true force at rest, and of an
IMU that turns in place, is g u:

    ψ̇ = δω − ω_e × ψ
    δv̇ = δf + ψ × g u − 2 ω_e × δv + (g / R) (2 u uᵀ − (I − u uᵀ)) δr        δṙ = δv

(Titterton & Weston 2004, chapter 12; Groves, Principles of GNSS, Inertial, and Multisensor
Integrated Navigation Systems, 2nd ed. 2013, chapter 14.) It is linear with constant coefficients,
so a constant error over a step is integrated exactly.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag, expm

from inertial.arrays import Array
from inertial.physics.motion import cross
from inertial.physics.strapdown import EARTH_RADIUS

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
