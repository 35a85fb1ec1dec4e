"""An axis that stands still is found for as long as it does; coarse counts stand still by right."""

import numpy as np
import pytest
from on_a_table import carried, recorded, rest, tumble, turn
from recorded_by_hand import COUNT, NOISE, assert_told
from scipy.signal import butter, lfilter

from inertial.campaign.findings import detections_of
from inertial.detectors.dead_axis import DeadAxis
from inertial.signal.steps import steps

DEAD = DeadAxis()


def found(values, **of_log):
    one, log = recorded(values, **of_log)
    events = list(DeadAxis().detect(one, log))
    for event in events:
        assert_told(DeadAxis(), event, "log")
    return events


def stretches(values, **of_log):
    return [(event.channel, event.first, event.after) for event in found(values, **of_log)]


@pytest.mark.parametrize("samples", [14, 100, 2000])
def test_a_frozen_axis_is_found_as_long_as_it_is_frozen(samples):
    values = rest(5000)
    values[1500 : 1500 + samples, 4] = values[1500, 4] + 3 * COUNT[4]
    ((channel, first, after),) = stretches(values)
    assert channel == 4
    assert abs(first - 1500) <= 1
    assert abs(after - 1500 - samples) <= 1


@pytest.mark.parametrize("samples", [4, 10, 500])
def test_zeros_in_a_turn_are_found_however_short(samples):
    values = turn()
    values[2000 : 2000 + samples, 5] = 0.0
    (event,) = found(values)
    assert (event.channel, event.first, event.after) == (5, 2000, 2000 + samples)
    words = DeadAxis().describe(event, "log")
    assert "gyro z reads 0 °/s" in words.sentence and "below a threshold" in words.action


def test_in_short_rests_between_motions_slow_noise_goes_from_count_to_count():
    """Behind a filter of 3 Hz gyros of coarse counts stood still for 20 readings: "dead"."""
    random, values = np.random.default_rng(3), rest(8000)
    time = np.arange(8000) / 100
    moving = np.sin(np.pi * np.clip(time % 8 / 6, 0, 1)) ** 2  # 6 s of motion, 2 s of rest
    slow = lfilter(*butter(2, 3, fs=100), random.normal(size=(8000, 3)), axis=0)
    slow *= 0.5 / slow.std(axis=0)
    rates = 900 * moving[:, None] * np.sin(2 * np.pi * 3 * time[:, None] + np.arange(3)) + slow
    values[:, 3:] = COUNT[3:] * np.rint(rates + np.array([9.4, -5.5, 19.6]))
    assert not found(values)


def test_an_axis_that_never_changes_is_measured_by_the_other_axes():
    values = rest(3000)
    values[:, 1] = 0.0
    (event,) = found(values)
    assert (event.channel, event.first, event.after) == (1, 0, 3000)
    words = DeadAxis().describe(event, "up.asc")
    assert "accelerometer y reads 0 m/s² in all 3\u202f000 readings" in words.sentence
    assert "Their mean is 0 m/s²" in words.consequence
    values[:, 1] = 19.6133
    (event,) = found(values)
    assert "limit of the range" in DeadAxis().describe(event, "up.asc").action


def motions_and_rests(repeats):
    """Turns with noise and the rests between them, and where the rests are."""
    parts = [part for _ in range(repeats) for part in (rest(800), turn()[1000:2000])]
    still = np.concatenate([np.full(len(part), k % 2 == 0) for k, part in enumerate(parts)])
    return np.concatenate(parts), still


@pytest.mark.parametrize("axes", [[5], [3, 4, 5]])
def test_gyros_that_read_zero_in_every_rest_stand_still_there(axes):
    """Most readings are 0 then: their noise shows in the turns alone."""
    values, still = motions_and_rests(6)
    for axis in axes:
        values[still, axis] = 0.0
    found_there = {(first, after) for channel, first, after in stretches(values) if channel == 5}
    edges = np.flatnonzero(np.diff(still.astype(int), prepend=0, append=0))
    assert found_there == set(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def test_a_sensor_that_never_changes_is_dead_where_the_other_is_not():
    values = rest(3000)
    values[:, 3:] = 0.0
    assert [channel for channel, _, _ in stretches(values)] == [3, 4, 5]


def test_of_readings_without_any_noise_nothing_is_said():
    values = np.tile([0.0, 0.0, 9.81, 0.0, 0.0, 0.0], (5000, 1))
    assert found(values) == []
    values[:, 3:] = np.nan
    assert found(values) == []


def test_a_channel_that_is_not_recorded_is_not_dead():
    values = rest(3000)
    values[:, 5] = np.nan
    assert found(values) == []


@pytest.mark.parametrize("noise", [0.02, 0.1, 0.3, 0.5, 0.7, 1.0, 2.0])
def test_coarse_counts_are_not_dead(noise):
    for seed in range(3):
        generator = np.random.default_rng(seed)
        # Rests at levels that lie anywhere between two counts: some never change.
        levels = np.repeat(generator.uniform(0, 1, (8, 6)), 3000, axis=0)
        plain = np.rint(levels + noise * generator.standard_normal(levels.shape)) * COUNT
        assert found(plain) == []
        assert found(carried(levels * COUNT, seed, noise * COUNT)) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    assert [found(values) for values in (rest(200_000, seed), turn(seed), tumble(seed))] == [[]] * 3
    assert found(rest(200_000, seed, noise=NOISE / 3)) == []


@pytest.mark.parametrize(
    ("channels", "said"),
    [
        ([3, 4, 5], "gyros x, y, z stand still together, 20"),
        ([2, 5], "accelerometer z and gyro z stand still together, 20"),
    ],
)
def test_axes_that_stand_still_over_the_same_records_are_one_finding(channels, said):
    """As zeros between packets; one that stands still elsewhere by itself is another one."""
    values = turn()
    for first in (1500, 2200):
        values[first : first + 200, channels] = 0.0
    values[2600:2900, 0] = 0.0
    one, log = recorded(values)
    events = {}
    for event in DeadAxis().detect(one, log):
        events.setdefault((DEAD, "log", event.channel), []).append(event)
    alone, together = sorted(
        (each.finding for each in detections_of("quality", events, {"log": log})),
        key=lambda finding: finding.count,
    )
    assert (alone.sensor, alone.axis, alone.count) == ("accel", "x", 1)
    assert said in together.sentence and "2 times in this log" in together.sentence
    sensor = "gyro" if channels[0] == 3 else None
    assert (together.sensor, together.axis, together.count) == (sensor, None, 2)


def test_a_dead_band_is_searched_for_steps_to_the_last_reading():
    """A step among the last readings of a window, behind the middle of its last block."""
    random = np.random.default_rng(482)
    count = int(random.integers(1500, 4000))
    readings = random.normal(size=count) * random.uniform(0.5, 3)
    readings[np.abs(readings) < 1] = 0
    for _ in range(5):
        first = int(random.integers(0, count - 50))
        readings[first : first + int(random.integers(20, 400))] = 0
    readings[random.integers(0, count) :] += random.uniform(0, 1)
    found_steps = steps(readings, interval=0.01, quantum=1e-3, level=0.005)
    assert all(np.isfinite([step.size, step.sigma]).all() for step in found_steps)
