"""Normal gravity, the earth's rate and the earth's radii at a site.

Constants of WGS 84 (NGA.STND.0036, 2014).
"""

from math import cos, sin, sqrt

EARTH_RATE = 7.292115e-5  # rad/s
SEMI_MAJOR = 6378137.0  # m
FLATTENING = 1 / 298.257223563
ECCENTRICITY2 = 0.00669437999014  # e² = f (2 − f)


def normal_gravity(latitude: float, height: float) -> float:
    """Gravity of the reference ellipsoid at `latitude` (rad) and `height` (m), in m/s².

    Somigliana's closed formula, and its continuation upwards to second order in the
    height (Heiskanen & Moritz 1967, 2-215).
    """
    equator, k, m = 9.7803253359, 0.00193185265241, 0.00344978650684
    squared = sin(latitude) ** 2
    surface = equator * (1 + k * squared) / sqrt(1 - ECCENTRICITY2 * squared)
    ratio = height / SEMI_MAJOR
    return surface * (
        1 - 2 * ratio * (1 + FLATTENING + m - 2 * FLATTENING * squared) + 3 * ratio**2
    )


def earth_rate(latitude: float) -> tuple[float, float]:
    """The earth's rate at `latitude` (rad): upward and northward components, rad/s."""
    return EARTH_RATE * sin(latitude), EARTH_RATE * cos(latitude)


def radii(latitude: float) -> tuple[float, float]:
    """Radii of curvature of the ellipsoid at `latitude` (rad): meridian, prime vertical, in m."""
    squared = 1 - ECCENTRICITY2 * sin(latitude) ** 2
    return SEMI_MAJOR * (1 - ECCENTRICITY2) / squared**1.5, SEMI_MAJOR / sqrt(squared)
