"""The type of IMU that a receiver tells, against the size of the campaign's counts."""

import numpy as np
import pytest
from recorded_by_hand import INTERVAL, assert_told, log, piece, rest, stamps

from inertial.detectors.receiver_statements import IMU_TYPES, WrongImuType

KVH, KVH_TOO, FSAS, EPSON = 33, 16, 13, 41


def concluded(*imu: int, count: np.ndarray | None = None):
    one = piece(rest(500), stamps(500))
    counts = {} if count is None else {"count": count}
    whole = log(one, None, imu=imu, increments=True, **counts)
    events = list(WrongImuType().detect_in_log(whole))
    for event in events:
        assert_told(WrongImuType(), event, "log")
    return events


@pytest.mark.parametrize("imu", [(), (KVH,), (KVH_TOO,), (0,), (255,)])
def test_the_campaign_s_own_type_and_what_is_in_no_list_are_no_finding(imu):
    assert not concluded(*imu)


def test_another_type_is_off_by_a_radian_in_degrees_and_told_by_name():
    """S0 takes its IMU for an iMAR-FSAS; its gyro counts are 57.3 times as large."""
    (event,) = concluded(FSAS)
    assert event.size == pytest.approx(180 / np.pi, rel=1e-6)
    assert "iMAR iIMU-FSAS" in WrongImuType().describe(event, "log").sentence


def test_two_types_in_one_log_are_named():
    (event,) = concluded(KVH, FSAS)
    assert event.size == 2


def test_a_count_that_is_a_rate_goes_with_the_interval():
    """Epson G320N: 0.008/2¹⁶ °/s and 0.2/2¹⁶ mg a count, both over the output rate."""
    rates = np.array([0.2 / 2**16 * 9.80665e-3] * 3 + [np.radians(0.008 / 2**16)] * 3)
    assert not concluded(EPSON, count=rates)
    gyro, force = IMU_TYPES[EPSON].counts(INTERVAL)
    assert (force, gyro) == pytest.approx((rates[0] * INTERVAL, rates[3] * INTERVAL))


@pytest.mark.parametrize(
    ("number", "gyro", "force"),
    [  # NovAtel OEM7 manual, Table: Raw IMU Scale Factors, in rad and m/s
        (1, 2.0**-33, 2.0**-27 * 0.3048),
        (8, 2.0**-19, 2.0**-14),
        (13, np.radians(0.1 / 256 / 3600), 0.05 / 2**15),
        (31, np.radians(720 / 2**31), 200 / 2**31),
        (32, np.radians(2.0**-21), 2.0**-22),
        (33, 0.1 / (3600 * 256), 0.05 / 2**15),
        (58, 2.0**-33, 2.0**-29),
    ],
)
def test_the_sizes_are_those_of_the_manual(number, gyro, force):
    assert IMU_TYPES[number].counts(0.01) == pytest.approx((gyro, force), rel=1e-12)
