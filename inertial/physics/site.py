"""Normal gravity and the earth's rate at a site.

Constants of WGS 84 (NGA.STND.0036, 2014).
"""

from math import cos, sin, sqrt

EARTH_RATE = 7.292115e-5  # rad/s


def normal_gravity(latitude: float, height: float) -> float:
    """Gravity of the reference ellipsoid at `latitude` (rad) and `height` (m), in m/s².

    Somigliana's closed formula, and its continuation upwards to second order in the
    height (Heiskanen & Moritz 1967, 2-215).
    """
    equator, k, e2 = 9.7803253359, 0.00193185265241, 0.00669437999014
    semi_major, flattening, m = 6378137.0, 1 / 298.257223563, 0.00344978650684
    squared = sin(latitude) ** 2
    surface = equator * (1 + k * squared) / sqrt(1 - e2 * squared)
    ratio = height / semi_major
    return surface * (
        1 - 2 * ratio * (1 + flattening + m - 2 * flattening * squared) + 3 * ratio**2
    )


def earth_rate(latitude: float) -> tuple[float, float]:
    """The earth's rate at `latitude` (rad): upward and northward components, rad/s."""
    return EARTH_RATE * sin(latitude), EARTH_RATE * cos(latitude)
