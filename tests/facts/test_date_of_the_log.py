"""S0: the GPS time of its two lines against the date on its cover (T24)."""

from datetime import UTC, date, datetime, timedelta, timezone

from inertial.formats.gps_time import NANOSECONDS, WEEK, utc

BEIJING = timezone(timedelta(hours=8))


def test_t24_the_log_is_ten_days_older_than_the_report_says():
    recorded = utc((2283 * WEEK * 1000 + 42_699_880) * NANOSECONDS // 1000)
    assert recorded == datetime(2023, 10, 8, 11, 51, 21, 880_000, UTC)
    there = recorded.astimezone(BEIJING)
    assert (there.hour, there.minute, there.strftime("%A")) == (19, 51, "Sunday")
    assert date(2023, 10, 18) - there.date() == timedelta(days=10)
    cover = datetime(2023, 10, 18, tzinfo=BEIJING) - datetime(1980, 1, 6, tzinfo=UTC)
    assert cover.days // 7 == 2284
