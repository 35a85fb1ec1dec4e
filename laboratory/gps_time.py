"""GPS time in whole nanoseconds since 6 January 1980: exact, also across the end of a week."""

import numpy as np

from laboratory.arrays import Counts

NANOSECONDS = 1_000_000_000  # in a second
WEEK = 604_800  # s


def gps_nanoseconds(week: int, second: float) -> int:
    """Nanoseconds since the start of GPS time."""
    return week * WEEK * NANOSECONDS + round(second * NANOSECONDS)


def week_and_second(stamps: Counts, decimals: int) -> tuple[Counts, Counts, Counts]:
    """Week, whole second and the fraction as a whole number of `decimals` digits, rounded.

    Rounding comes first: 604799.9996 s with three decimals is second 0 of the next week.
    """
    unit = 10 ** (9 - decimals)
    rounded = (stamps + unit // 2) // unit
    seconds, fraction = np.divmod(rounded, 10**decimals)
    week, second = np.divmod(seconds, WEEK)
    return week, second, fraction
