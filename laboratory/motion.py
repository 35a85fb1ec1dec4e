"""Motion of the case of the IMU: a product of rotations, that of the table first."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from laboratory.arrays import Array
from laboratory.instants import Instants
from laboratory.rotation import rotation_about, seen_from


@dataclass(frozen=True)
class Turning:
    """A rotation about an axis that is fixed in the rotated body."""

    axis: Array  # unit vector, (3,), axes of the rotated body
    angle: Array  # rad, (m,), right-hand rule
    rate: Array  # rad/s, (m,)
    acceleration: Array  # rad/s², (m,)
    steady_rate: float  # rad/s, greatest magnitude of the rate
    planned: bool = True  # False for a change of position


@dataclass(frozen=True)
class Motion:
    """Attitude and rotation of the case against the ground; m instants, n samples, body axes."""

    instants: Instants
    attitude: Array  # level (east, north, up) from body, (m, 3, 3)
    rate: Array  # rad/s, (m, 3), without the earth's own
    acceleration: Array  # rad/s², (m, 3)
    turned: Array  # rad, (n, 3): integral of the rate over every sample
    at_rest: bool  # there is no rotation

    def seen(self, vector: Array) -> Array:
        """A vector of the level frame, (3,), in the axes of the case at the instants, (m, 3)."""
        if self.at_rest:
            return np.broadcast_to(seen_from(self.attitude[0], vector), self.rate.shape)
        return seen_from(self.attitude, vector)

    @property
    def rate_change(self) -> Array:
        """Rate at the end less rate at the start of every sample, (n, 3), rad/s."""
        return self.instants.difference(self.rate)


def move(instants: Instants, attitude: Array, turnings: Sequence[Turning]) -> Motion:
    """The motion of a case from `attitude`, (3, 3), by rotations.

    C = C₀ R₁ R₂ …; with each further turning by angle ψ about axis a
        ω ← Rᵀ ω + a ψ′,   ω′ ← Rᵀ ω′ + (Rᵀ ω) × a ψ′ + a ψ″.
    The part Σ a ψ′ of ω is integrated exactly, by differences of angles; only the rotation of the
    axes of earlier rotations is integrated by quadrature, so corners of the rate cause no error.
    """
    m = len(instants.elapsed)
    rate, acceleration, plain = np.zeros((3, m, 3))
    turned = np.zeros((instants.samples, 3))
    attitudes = np.broadcast_to(attitude, (m, 3, 3))
    for turning in turnings:
        rotation = rotation_about(turning.axis, turning.angle)
        own_rate = turning.rate[:, None] * turning.axis
        carried = seen_from(rotation, rate)
        acceleration = (
            seen_from(rotation, acceleration)
            + np.cross(carried, own_rate)
            + turning.acceleration[:, None] * turning.axis
        )
        rate = carried + own_rate
        attitudes = attitudes @ rotation
        plain = plain + own_rate
        turned = turned + instants.difference(turning.angle)[:, None] * turning.axis
    if len(turnings) > 1:
        turned = turned + instants.integral(rate - plain)
    return Motion(instants, attitudes, rate, acceleration, turned, not turnings)
