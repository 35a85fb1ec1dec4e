"""The site: gravity and the rotation of the earth in the level frame.

Level frame: east, north, up.
"""

from dataclasses import dataclass
from math import cos, sin, sqrt

import numpy as np

from laboratory.arrays import Array

EARTH_RATE = 7.292115e-5  # rad/s, WGS 84


@dataclass(frozen=True)
class Site:
    """The true site."""

    latitude: float  # rad
    gravity: float  # m/s²
    heading: float | None  # rad clockwise from north: the table's zero mark; None: random
    spin: float = 1.0  # fraction of the earth rate in the readings of the gyros

    @property
    def earth_rate(self) -> Array:
        """ω_e (0, cos φ, sin φ), (3,), rad/s."""
        return self.spin * EARTH_RATE * np.array([0.0, cos(self.latitude), sin(self.latitude)])

    @property
    def reaction(self) -> Array:
        """Specific force at rest, (3,), m/s²: +g upwards."""
        return np.array([0.0, 0.0, self.gravity])


def normal_gravity(latitude: float, height: float) -> float:
    """Gravity of the WGS 84 ellipsoid, m/s², at a latitude (rad) and an ellipsoidal height (m).

    Somigliana's formula, with height to the second order: NIMA TR8350.2, eq. 4-1 and 4-3.
    """
    equator, k, e2 = 9.7803253359, 0.00193185265241, 0.00669437999014
    a, flattening, m = 6378137.0, 1 / 298.257223563, 0.00344978650684
    s2 = sin(latitude) ** 2
    level = equator * (1 + k * s2) / sqrt(1 - e2 * s2)
    along = 1 + flattening + m - 2 * flattening * s2
    return level * (1 - 2 * along * height / a + 3 * (height / a) ** 2)
