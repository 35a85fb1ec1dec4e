"""By how much gravity differs from normal gravity, and what is no gravity of a place."""

from math import asin, degrees, hypot, sqrt

from inertial.physics.site import normal_gravity

# m/s²: gravity differs from normal gravity, point by point over the earth, by 42 mGal rms
# (variance 1795 mGal²: Tscherning & Rapp, OSU Report 208, 1974); rounded up.
ANOMALY_SIGMA = 5e-4
MIN_SIGMA = 3.0  # sigma
LOWEST, HIGHEST = -500.0, 9000.0  # m, where a laboratory can stand
STEPS = 60  # of a bisection: to the last digit


def is_refuted(stated: float, sigma: float, latitude: float, height: float | None) -> bool:
    """Whether a gravity, m/s², differs from normal gravity by more than anomalies and its sigma.

    Where the height, m, is not stated, none may explain it. `latitude`: rad.
    """
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
