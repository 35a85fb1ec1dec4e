"""A firmware that reads zero in place of what is small is told from zeros of other kinds."""

from types import SimpleNamespace

import numpy as np
import pytest
from recorded_by_hand import INTERVAL, piece, seen, stamps

from inertial.campaign.log_properties import ChannelStatistics
from inertial.detectors.dead_axis import DeadAxis
from inertial.detectors.zero_below_threshold import ZeroBelowThreshold

THRESHOLD, NOISE = np.radians(0.3), np.radians(0.07)  # rad/s
RATE, RAMP = np.radians(40.0), np.radians(20.0)  # rad/s, rad/s²


def turns(bias: float = np.radians(0.14), number: int = 6) -> np.ndarray:
    """Six channels of rests of 20 s and turns there and back about all axes, of a MEMS."""
    ramp = np.arange(0, RATE, RAMP * INTERVAL)
    turn = np.concatenate([ramp, np.full(700, RATE), ramp[::-1]])
    profile = np.concatenate([np.zeros(2000), turn, np.zeros(300), -turn, np.zeros(300)])
    rate = np.tile(profile, number)
    random = np.random.default_rng(7)
    gyros = rate[:, None] + bias + NOISE * random.standard_normal((len(rate), 3))
    force = [0.0, 0.0, 9.8] + 0.015 * random.standard_normal((len(rate), 3))
    return np.hstack([force, gyros])


def thresholds(values: np.ndarray) -> np.ndarray:
    """By channel, of a log in two pieces."""
    of_log = ChannelStatistics()
    for part in np.array_split(values, 2):
        of_log.add(SimpleNamespace(log="log", readings=part))
    return of_log.table()["threshold"].to_numpy()


def set_to_zero(values: np.ndarray, threshold: float = THRESHOLD) -> np.ndarray:
    found = values.copy()
    gyros = found[:, 3:]
    gyros[np.abs(gyros) < threshold] = 0.0
    return found


@pytest.mark.parametrize("bias", np.radians([0.0, 0.14, -0.4]))
@pytest.mark.parametrize("threshold", np.radians([0.3, 1.0]))
def test_the_threshold_is_that_of_the_firmware(threshold, bias):
    values = set_to_zero(turns(bias), threshold)
    found = thresholds(values)
    assert np.isnan(found[:3]).all()
    np.testing.assert_allclose(found[3:], threshold, rtol=0.1)


def lost_readings() -> np.ndarray:
    """Single readings that a logger fills with 0, among them those of gravity."""
    values = turns()
    values[::50] = 0.0
    return values


def not_yet_started() -> np.ndarray:
    """Zeros until the sensor is ready, whose bias no turn goes beyond the other way."""
    values = turns(bias=np.radians(60.0))
    values[:1500] = 0.0
    return values


def coarse() -> np.ndarray:
    """Counts of 0.3 °/s, among which 0 is one."""
    values = turns()
    values[:, 3:] = np.round(values[:, 3:] / THRESHOLD) * THRESHOLD
    return values


@pytest.mark.parametrize(
    "values", [turns(), lost_readings(), not_yet_started(), coarse(), np.zeros((9000, 6))]
)
def test_zeros_of_another_kind_are_no_threshold(values):
    assert np.isnan(thresholds(values)).all()


def test_logs_in_which_nothing_changes_or_that_lack_a_sensor_show_none():
    of_logs = ChannelStatistics()
    constant = {"up": 1.0, "down": -1.0, "nothing": 0.0}
    for log, value in constant.items():
        of_logs.add(SimpleNamespace(log=log, readings=np.full((99, 6), value)))
    assert of_logs.table()["threshold"].isna().all()


def test_a_log_without_gyros_hides_no_threshold_of_another():
    alone = np.hstack([np.ones((99, 3)), np.full((99, 3), np.nan)])
    of_logs = ChannelStatistics()
    for log, readings in (("static", alone), ("turns", set_to_zero(turns()))):
        of_logs.add(SimpleNamespace(log=log, readings=readings))
    found = of_logs.table().query("log == 'turns' and sensor == 'gyro'")["threshold"]
    np.testing.assert_allclose(found, THRESHOLD, rtol=0.1)


def test_what_is_small_is_masked_and_no_axis_is_dead():
    """With none of the readings that noise lifts over the threshold: their mean is above it."""
    values = set_to_zero(turns())
    one = piece(values, stamps(len(values)))
    events = seen(ZeroBelowThreshold(), one, threshold=thresholds(values))
    assert sum(event.size for event in events) == np.count_nonzero(values == 0)
    assert all(ZeroBelowThreshold().censors(event) for event in events)
    assert not seen(DeadAxis(), one.without(events))
    left = one.without(events).values[:, 3:]
    assert np.nanmin(np.abs(left)) >= 2 * THRESHOLD * 0.98
    turning = np.abs(left) > np.radians(1.0)
    assert np.count_nonzero(turning) == np.count_nonzero(np.abs(values[:, 3:]) > np.radians(1.0))
    told = ZeroBelowThreshold().describe_many([("log", event) for event in events]).sentence
    assert "less than 0.300 °/s, of either sign, gyros x, y, z read exactly 0" in told
