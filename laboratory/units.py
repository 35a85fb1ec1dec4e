"""The units of specifications, each as its value in SI and radians.

A number is multiplied by its unit when it is read: `rate = 10 * DEGREE`.
"""

from math import pi
from typing import Final

DEGREE: Final = pi / 180  # rad
PPM: Final = 1e-6
MILLISECOND: Final = 1e-3  # s
MICROSECOND: Final = 1e-6  # s
MILLIRADIAN: Final = 1e-3  # rad
ARCSECOND: Final = DEGREE / 3600  # rad
MINUTE: Final = 60.0  # s
HOUR: Final = 3600.0  # s
ROOT_HOUR: Final = 60.0  # √s
ICE_POINT: Final = 273.15  # K, 0 °C
STANDARD_GRAVITY: Final = 9.80665  # m/s², the "g" of deg/h/g and of µg; not the local gravity
MILLIGAL: Final = 1e-5  # m/s²
MICROGRAVITY: Final = 1e-6 * STANDARD_GRAVITY  # m/s²
