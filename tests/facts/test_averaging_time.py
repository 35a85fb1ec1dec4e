"""S0, equations 5-1 and 5-2: how long to average, with √h and s in the same unit (T9)."""

import numpy as np
import pytest
import s0

from inertial.campaign.estimates import Wanted
from inertial.physics.site import earth_rate

RW = s0.per_root_second(s0.VELOCITY_RANDOM_WALK)  # m/s/√s
MILLIGAL = 1e-5  # m/s²
DAY = 86400


def averaging_time(walk: float, wanted: float, means: int = 1, floor: float = 0.0) -> float | None:
    """Seconds for each of some means of white noise `walk`, as the estimates have them."""
    in_a_second = Wanted(float(np.hypot(walk / np.sqrt(means), floor)), floor, 1.0)
    return in_a_second.row(wanted)["wanted_seconds"]


def test_t9_81_seconds_are_22_milliseconds():
    bias = 1000 * MILLIGAL
    assert averaging_time(s0.VELOCITY_RANDOM_WALK, bias / 3) == pytest.approx(81)  # as S0 has it
    assert averaging_time(RW, bias / 3) == pytest.approx(0.0225)
    own = [averaging_time(RW, abs(b) / 3) for b in s0.ACCELEROMETER_BIAS]
    np.testing.assert_allclose(own, [0.0803, 0.0877, 0.637], rtol=1e-3)


def test_what_a_wanted_sigma_costs():
    assert averaging_time(RW, MILLIGAL) == pytest.approx(2500)
    assert averaging_time(RW, 10e-6 * s0.GRAVITY, means=2) == pytest.approx(13.0, abs=0.05)
    assert averaging_time(RW, 1e-6 * s0.GRAVITY, means=2) == pytest.approx(1303, abs=1)


def test_the_scale_factor_of_a_gyro_from_the_earth_rate_takes_weeks():
    """300 ppm of ω_e sinφ up and down; design study, 4.5 has 39.65 days, by rounding: 39.66."""
    up, _ = earth_rate(s0.LATITUDE)
    for walk, days in ((0.1, 39.66), (0.03, 3.57), (0.012, 0.57)):
        seconds = averaging_time(s0.per_root_second(np.radians(walk)), 300e-6 * up, means=2)
        assert seconds / DAY == pytest.approx(days, abs=0.005)


def test_what_does_not_average_out_is_no_matter_of_time():
    tilt = 2 / 206265 * s0.GRAVITY  # 2″ are 95 µm/s²
    assert averaging_time(RW, 5 * MILLIGAL, floor=tilt) is None
    assert averaging_time(RW, 0.2 * np.sqrt(1.25) * tilt * 5, floor=tilt) == pytest.approx(
        (RW / (0.5 * tilt)) ** 2
    )
