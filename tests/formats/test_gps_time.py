"""GPS time against dates that are known."""

from datetime import datetime, timedelta, timezone

import pytest

from inertial.formats.gps_time import LEAP_SECONDS, NANOSECONDS, WEEK, utc


def stamp(week: int, seconds: float) -> int:
    return week * WEEK * NANOSECONDS + round(seconds * NANOSECONDS)


def test_the_day_on_which_the_lines_of_the_laboratory_report_were_recorded():
    # T24: ten days before the date of the report, in the afternoon of a Chinese Sunday
    recorded = utc(stamp(2283, 42699.88))
    assert recorded.isoformat() == "2023-10-08T11:51:21.880000+00:00"
    beijing = recorded.astimezone(timezone(timedelta(hours=8)))
    assert beijing.strftime("%H:%M:%S") == "19:51:21"


@pytest.mark.parametrize(
    ("week", "seconds", "date"),
    [
        (0, 0, "1980-01-06T00:00:00+00:00"),
        (1024, 13, "1999-08-22T00:00:00+00:00"),  # first rollover of the week, 13 leap seconds
        (2048, 18, "2019-04-07T00:00:00+00:00"),  # second one, 18
        (1930, 17, "2017-01-01T00:00:00+00:00"),  # 23:59:60, which has no name here
        (1930, 18, "2017-01-01T00:00:00+00:00"),
        (1930, 16, "2016-12-31T23:59:59+00:00"),
    ],
)
def test_leap_seconds_are_counted_from_the_day_they_apply(week, seconds, date):
    assert utc(stamp(week, seconds)) == datetime.fromisoformat(date)


def test_there_were_eighteen_leap_seconds():
    assert len(LEAP_SECONDS) == 18
    assert list(LEAP_SECONDS) == sorted(LEAP_SECONDS)
