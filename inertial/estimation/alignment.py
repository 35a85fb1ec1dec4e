"""Coarse alignment at rest and over a turn, and the error of the attitude that follows.

Local level frame: east, north, up. The IMU rests, or turns about an axis that points up.

At rest the mean specific force points up and the mean rate, less its part along up, points north.
A bias of the gyros to the east turns that north by b_E / (ω_e cos φ), and nothing at rest shows it.
While the IMU turns by θ, what is fixed in the case (bias b, and the cross terms m of the rate)
keeps its direction in body axes, what is fixed in the laboratory turns in them:

    ω̃ = b + m θ' + R(−θ) ω_h        f̃ = a + R(−θ) g τ

so that both are told from each other, S4's rotation modulation. For the same reason the integral
of the rate that remains in the level frame, which grows as b t at rest, goes round a circle:

    φ(t) = ∫ R(θ) b dt,   |φ| = 2 b/Ω |sin Ωt/2|   at a steady rate Ω

The part along the axis is not modulated: its bias, and the scale factor's error times θ, remain.
"""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.physics.motion import cross, horizontal, level_axes, north_of, turned_all


@dataclass(frozen=True)
class CoarseAlignment:
    """East, north and up in body axes, rows of `axes`, (3, 3).

    `tilt_sigma`: rad, of up about either level axis; `heading_sigma`: rad, by noise; `per_bias`:
    rad per rad/s, by which a bias of the gyros to the east turns the heading.
    """

    axes: Array
    tilt_sigma: float
    heading_sigma: float
    per_bias: float

    @property
    def up(self) -> Array:
        """Up in body axes, (3,)."""
        return np.asarray(self.axes[2])

    def azimuth(self, direction: Array) -> float:
        """The azimuth of a body direction, clockwise from north, rad."""
        return float(np.arctan2(self.axes[0] @ direction, self.axes[1] @ direction))

    def with_azimuth(self, direction: Array, azimuth: float, sigma: float) -> "CoarseAlignment":
        """The same levels with a known azimuth of a body direction."""
        north = north_of(self.up, horizontal(direction, self.up), azimuth)
        return _aligned(self.up, north, self.tilt_sigma, sigma, 0.0)


def _aligned(
    up: Array, north: Array, tilt_sigma: float, heading_sigma: float, per_bias: float
) -> CoarseAlignment:
    axes = np.stack([cross(north, up), north, up])
    return CoarseAlignment(axes, tilt_sigma, heading_sigma, per_bias)


def at_rest(
    force: Array, rate: Array, force_sigma: float, rate_sigma: float, up_rate: float
) -> CoarseAlignment:
    """Alignment by the means at rest, (3,) each, m/s² and rad/s, with the sigma of each component.

    `up_rate`: rad/s, upward earth rate, by which a tilt turns the heading: σ tan φ.
    """
    size = float(np.linalg.norm(force))
    up = force / size
    level = rate - (rate @ up) * up
    horizontal = float(np.linalg.norm(level))
    tilt = force_sigma / size
    heading = float(np.hypot(rate_sigma, up_rate * tilt)) / horizontal
    return _aligned(up, level / horizontal, tilt, heading, 1 / horizontal)


@dataclass(frozen=True)
class Separated:
    """What is fixed in the case and what is fixed in the laboratory, across the axis of a turn.

    `fixed`: (3,), in body axes; `growing`: (3,), likewise, per rad/s of the table; `turning`: (3,),
    in body axes at θ = 0; `sigma`: of each level component of `turning`, and `fixed_sigma` of what
    is fixed at the mean rate.
    """

    fixed: Array
    growing: Array
    turning: Array
    sigma: float
    fixed_sigma: float


def separated(means: Array, angle: Array, rate: Array, about: Array, sigma: Array) -> Separated:
    """Least squares over k stretches of a turn: means (k, 3), angle and rate of the table (k,).

    `sigma`: (k,), of a component of a mean. Where the rate is the same all the time `fixed` and
    `growing` are not told from each other; their sum is.
    """
    first, second = level_axes(about)
    zero, one = np.zeros(len(means)), np.ones(len(means))
    along = [turned_all(direction, about, angle) for direction in (first, second)]
    design, read = [], []
    for i, direction in enumerate((first, second)):
        own = [(one, zero), (rate, zero)]
        columns = [each[0 if i == j else 1] for each in own for j in range(2)]
        columns += [part @ direction for part in along]
        design.append(np.column_stack(columns) / sigma[:, None])
        read.append(means @ direction / sigma)
    matrix = np.concatenate(design)
    solution = np.linalg.lstsq(matrix, np.concatenate(read), rcond=None)[0]
    covariance = np.linalg.pinv(matrix.T @ matrix)
    fixed, growing, turning = (solution[i] * first + solution[i + 1] * second for i in (0, 2, 4))
    together = np.array([1.0, 0.0, float(rate.mean()), 0.0, 0.0, 0.0])
    return Separated(
        fixed,
        growing,
        turning,
        float(np.sqrt(np.diag(covariance)[4:].max())),
        float(np.sqrt(together @ covariance @ together)),
    )


@dataclass(frozen=True)
class AttitudeError:
    """The integral of the rate that remains, in the level frame.

    `seconds`: (k,), since the start; `angle`: (k, 3), rad, about east, north, up; `sigma`: (k,),
    rad, of each by white noise.
    """

    seconds: Array
    angle: Array
    sigma: Array

    def level(self) -> Array:
        """The error of the levels, (k,), rad."""
        return np.asarray(np.linalg.norm(self.angle[:, :2], axis=1))

    def largest(self, seconds: float) -> tuple[float, float]:
        """The largest error of the levels within a time, and its sigma, rad."""
        within = self.seconds <= seconds
        place = int(np.argmax(np.where(within, self.level(), -1.0)))
        return float(self.level()[place]), float(self.sigma[place])


def integrated(
    remains: Array, angle: Array, seconds: Array, about: Array, axes: Array, density: float
) -> AttitudeError:
    """Integrate rates that remain in body axes, (k, 3), over stretches of `seconds`, (k,).

    First order in the error. `angle`: (k,), rad, of the table in the middle of each stretch, 0
    where `axes`, (3, 3), hold: rows east, north, up; `density`: rad/√s, white noise of a gyro.
    """
    laboratory = turned_all(remains, about, -angle)  # in body axes at angle 0
    error = np.cumsum(laboratory * seconds[:, None], axis=0) @ axes.T
    passed = np.cumsum(seconds)
    return AttitudeError(passed, error, density * np.sqrt(passed))


@dataclass(frozen=True)
class Gained:
    """By how much less the levels err with rotation than without, within the same time."""

    seconds: float
    still: float
    still_sigma: float
    modulated: float
    modulated_sigma: float

    @property
    def factor(self) -> float:
        """Error without rotation over error with it, 1."""
        return self.still / self.modulated

    @property
    def sigma(self) -> float:
        """Standard deviation of the factor."""
        relative = np.hypot(self.still_sigma / self.still, self.modulated_sigma / self.modulated)
        return float(self.factor * relative)


def gained(modulated: AttitudeError, still: AttitudeError) -> Gained:
    """Compare a run with rotation with one without, over the shorter of the two."""
    seconds = float(min(modulated.seconds[-1], still.seconds[-1]))
    return Gained(seconds, *still.largest(seconds), *modulated.largest(seconds))
