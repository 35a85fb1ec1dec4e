"""Normal gravity and its anomalies, the earth's rate and the earth's radii at a site.

Constants of WGS 84 (NGA.STND.0036, 2014).
"""

from math import asin, cos, degrees, hypot, sin, sqrt

from inertial.text.units import STANDARD_GRAVITY

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


# ---- By how much gravity differs from normal gravity, and what is no gravity of a place

# m/s²: gravity differs from normal gravity, point by point over the earth, by 42 mGal rms
# (variance 1795 mGal²: Tscherning & Rapp, OSU Report 208, 1974); rounded up.
ANOMALY_SIGMA = 5e-4
MIN_SIGMA = 3.0  # sigma
LOWEST, HIGHEST = -500.0, 9000.0  # m, where a laboratory can stand
# m: nine in ten people live below 1000 m, and cities up to 4000 m.
USUAL_HEIGHT, HEIGHT_SIGMA = 500.0, 1000.0
MAX_SIGMA_OF_UNIT = 1e-3  # m/s²: who knows gravity so well has not copied the unit g
STEPS = 60  # of a bisection: to the last digit


def gravity_at(latitude: float, height: float | None) -> tuple[float, float]:
    """Gravity at `latitude`, rad, and `height`, m, None: not known; its sigma, m/s²."""
    if height is not None:
        return normal_gravity(latitude, height), ANOMALY_SIGMA
    value = normal_gravity(latitude, USUAL_HEIGHT)
    per_sigma = value - normal_gravity(latitude, USUAL_HEIGHT + HEIGHT_SIGMA)
    return value, hypot(ANOMALY_SIGMA, per_sigma)


def is_refuted(stated: float, sigma: float, latitude: float, height: float | None) -> bool:
    """Whether a gravity, m/s², differs from normal gravity by more than anomalies and its sigma.

    Where the height, m, is not stated, none may explain it, unless it is the unit g that is stated
    as if it had been measured. `latitude`: rad.
    """
    if height is None and stated == STANDARD_GRAVITY and sigma < MAX_SIGMA_OF_UNIT:
        return True
    if height is None:
        least, most = normal_gravity(latitude, HIGHEST), normal_gravity(latitude, LOWEST)
        off = stated - min(max(stated, least), most)
    else:
        off = stated - normal_gravity(latitude, height)
    return abs(off) > MIN_SIGMA * hypot(sigma, ANOMALY_SIGMA)


def latitude_of(gravity: float, height: float) -> float | None:
    """The northern latitude, degrees, at which normal gravity is this; None where nowhere."""
    low, high = 0.0, 1.0  # of the squared sine, in which it ascends
    if not _at(low, height) <= gravity <= _at(high, height):
        return None
    for _step in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if _at(middle, height) < gravity else (low, middle)
    return degrees(asin(sqrt(low)))


def _at(squared_sine: float, height: float) -> float:
    return normal_gravity(asin(sqrt(squared_sine)), height)
