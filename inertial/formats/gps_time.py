"""GPS time, in which NovAtel receivers stamp their lines, and the UTC date it stands for.

GPS time counts weeks and seconds from 1980-01-06 00:00:00 UTC without leap seconds, so it is ahead
of UTC by the leap seconds since then: 18 s from 2017 on. Source: IS-GPS-200, 3.3.4; IERS
Bulletin C (no leap second announced after that of 2016-12-31 at the time of writing).
"""

from bisect import bisect_right
from datetime import UTC, date, datetime, timedelta

NANOSECONDS = 1_000_000_000  # in a second
WEEK = 604_800  # s
EPOCH = datetime(1980, 1, 6, tzinfo=UTC)

# The first UTC day after each leap second.
LEAP_SECONDS = (
    date(1981, 7, 1),
    date(1982, 7, 1),
    date(1983, 7, 1),
    date(1985, 7, 1),
    date(1988, 1, 1),
    date(1990, 1, 1),
    date(1991, 1, 1),
    date(1992, 7, 1),
    date(1993, 7, 1),
    date(1994, 7, 1),
    date(1996, 1, 1),
    date(1997, 7, 1),
    date(1999, 1, 1),
    date(2006, 1, 1),
    date(2009, 1, 1),
    date(2012, 7, 1),
    date(2015, 7, 1),
    date(2017, 1, 1),
)

# GPS time, in seconds, at which each of these days begins: every one a second later than before.
_BEGINS = tuple(
    (day - EPOCH.date()).days * 86400 + count for count, day in enumerate(LEAP_SECONDS, start=1)
)


def utc(stamp: int) -> datetime:
    """UTC at `stamp`, ns since the start of GPS time, to the microsecond.

    A leap second itself, 23:59:60, is given as the second after it, for datetime has no name for
    it.
    """
    leaps = bisect_right(_BEGINS, stamp // NANOSECONDS)
    return EPOCH + timedelta(microseconds=stamp // 1000) - timedelta(seconds=leaps)
