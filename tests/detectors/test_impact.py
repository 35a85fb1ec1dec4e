"""A blow shakes all channels at once, and nothing remains; motions and spoilt records are none."""

import numpy as np
import pytest
from on_a_table import recorded, rest, tumble, turn
from recorded_by_hand import COUNT, INTERVAL, NOISE, assert_told

from inertial.detectors.disturbances import Impact


def found(values):
    one, log = recorded(values)
    events = list(Impact().detect(one, log))
    for event in events:
        assert_told(Impact(), event, "log")
    return events


def ringing(records, frequency=31.0, decay=0.08):
    """A decaying sine, (n, 1), from 0 on."""
    time = INTERVAL * np.arange(records)
    return (np.exp(-time / decay) * np.sin(2 * np.pi * frequency * time))[:, None]


def counted(values):
    return np.rint(values / COUNT) * COUNT


@pytest.mark.parametrize("times", [200, 2000, 50_000])
@pytest.mark.parametrize("still", [True, False], ids=["rest", "turn"])
def test_a_blow_is_found(times, still):
    """`times`: the noise of a reading."""
    values = rest(4000) if still else turn()
    share = np.array([0.9, -0.6, 0.4, 0.7, -0.8, 0.5])
    values[2000:2300] += counted(times * NOISE * share * ringing(300))
    (event,) = found(values)
    assert abs(event.first - 2000) <= 3
    audible = 0.08 * np.log(times) / INTERVAL  # records, until it is the noise of one
    assert 2000 + audible / 2 < event.after < 2000 + 3 * audible
    assert event.channel is None


@pytest.mark.parametrize("still", [True, False], ids=["rest", "turn"])
@pytest.mark.parametrize("frequency", [10.0, 23.0])
def test_a_blow_that_rings_for_seconds_in_the_accelerometers_alone_is_one(still, frequency):
    """It was none, and lines of the spectrum; and what rang on behind it was steps of the angle."""
    values = rest(6000) if still else turn()
    share = np.array([0.9, -0.6, 1.0, 0.02, -0.03, 0.02])
    values[2000:3500] += counted(4000 * NOISE * share * ringing(1500, frequency, 0.45))
    (event,) = found(values)
    assert abs(event.first - 2000) <= 6
    left = 4000 * np.exp(-INTERVAL * (event.after - 2000) / 0.45)
    assert left < 2  # noise of a reading
    assert event.after < 2000 + 12 / INTERVAL


def test_spoilt_records_steps_and_oscillations_are_none():
    values = rest(6000)
    values[1000:1003] += counted(1000 * NOISE)  # three records, all channels
    values[2000:, 3:] += counted(500 * NOISE)[3:]  # a step of the gyros
    time = INTERVAL * np.arange(1500)
    values[3000:4500] += counted(300 * NOISE * np.sin(2 * np.pi * 37 * time)[:, None])
    assert found(values) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    assert [found(values) for values in (rest(200_000, seed), turn(seed), tumble(seed))] == [[]] * 3


def test_a_hand_that_lifts_the_imu_is_none():
    """Half a second up and down by 0.1 m and 20°, smoothly."""
    values = rest(4000)
    phase = np.linspace(0, 2 * np.pi, 100)
    lift = 0.1 * (2 * np.pi / 1.0) ** 2 * np.cos(phase)
    values[2000:2100] += counted(np.outer(lift, [0.3, 0.5, 1, 0.2, 0.3, 0.2]))
    assert found(values) == []


def test_a_hand_that_turns_the_imu_in_a_moment_is_none():
    """Half a turn in 0.4 s with a jolt at either end: the angle remains, so it was a motion."""
    values = rest(4000)
    number = round(0.4 / INTERVAL)
    rate = np.pi / 0.4 * 2 * np.sin(np.linspace(0, np.pi, number)) ** 2
    shaken = np.random.default_rng(4).normal(0, 300, (number, 6)) * NOISE
    values[2000 : 2000 + number] += counted(shaken)
    values[2000 : 2000 + number, 4] += counted(np.tile(rate[:, None], 6))[:, 4]
    assert found(values) == []
