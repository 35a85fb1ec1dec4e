"""The units in which people write a campaign, in SI."""

from math import pi

from inertial.text.units import STANDARD_GRAVITY

DEGREE = pi / 180
ARC_SECOND = DEGREE / 3600
PER_ROOT_HOUR = 1 / 60  # a random walk per √h, per √s
CHANNEL_UNITS = {"m/s2": 1.0, "g": STANDARD_GRAVITY, "rad/s": 1.0, "deg/s": DEGREE}  # of a reading


def in_si(value: float | None, unit: float) -> float | None:
    """A value in a unit; none where it is not stated."""
    return None if value is None else value * unit
