"""Readings far off their neighbours are found to the record; motion, however rough, is none."""

import numpy as np
import pytest
from on_a_table import recorded, rest, tumble, turn
from recorded_by_hand import GRAVITY, INTERVAL, NOISE, assert_told, log, piece

from inertial.detectors.spike import Spikes, chance


def found(values, **of_log):
    one, whole = recorded(values, **of_log)
    events = list(Spikes().detect(one, whole))
    for event in events:
        assert_told(Spikes(), event, "log")
    return events


def places(values, **of_log):
    return [(event.channel, event.first, event.after) for event in found(values, **of_log)]


@pytest.mark.parametrize("times", [10, 100, 10_000])
@pytest.mark.parametrize("width", [1, 2, 3])
def test_a_spike_is_found_to_the_record(times, width):
    values = rest(6000)
    values[2500 : 2500 + width, 1] += times * NOISE[1]
    values[4000 : 4000 + width, 5] -= times * NOISE[5]
    events = found(values)
    assert [(event.channel, event.first, event.after) for event in events] == [
        (1, 2500, 2500 + width),
        (5, 4000, 4000 + width),
    ]
    for event, size in zip(events, (NOISE[1], -NOISE[5]), strict=True):
        assert event.size == pytest.approx(times * size, abs=3.5 * abs(size))
        assert event.p_value < 1e-4


def test_of_spikes_that_noise_could_hide_most_are_found_at_nine_sigma_and_none_is_invented():
    values = rest(60_000)
    hidden = np.arange(300, 59_000, 300)
    values[hidden, 0] += 9 * NOISE[0]
    seen = places(values)
    assert {first for _, first, _ in seen} <= set(hidden.tolist())
    assert len(seen) > 0.8 * len(hidden)


def test_noise_that_changes_in_a_turn_has_no_spikes():
    """A table shakes along north, so an accelerometer that goes round is loud now and then.

    Of the 1024 readings around one of six loud sigmas most are quiet.
    """
    values = rest(6000)
    loud = 2.2 * NOISE[0]
    level = values[:2000, 0].mean()
    values[2900:3100, 0] = level + loud * np.random.default_rng(7).standard_normal(200)
    values[3000, 0] = level + 5.9 * loud
    assert places(values) == []
    values[3000, 0] = level + 20 * loud
    assert places(values) == [(0, 3000, 3001)]


def test_its_words_tell_what_it_would_have_moved():
    values = rest(3000)
    values[1000, 2] += 30.0
    (event,) = found(values)
    words = Spikes().describe(event, "up.asc")
    assert "1 reading of accelerometer z is off the neighbours by +30.0 m/s²" in words.sentence
    assert "line 1001" in words.sentence
    assert "that of 1 s by +0.300 m/s²" in words.consequence
    assert "of all 3\u202f000 readings by +0.0100 m/s²" in words.consequence


def test_a_spike_in_a_steady_turn_and_on_a_ramp_is_found():
    values = turn()
    values[1200, 5] += 0.01  # the ramp rises by 8.7e-4 rad/s from reading to reading
    values[2500, 5] -= 0.001
    values[2600, 0] += 0.05
    assert places(values) == [(0, 2600, 2601), (5, 1200, 1201), (5, 2500, 2501)]


@pytest.mark.parametrize("acceleration", [200.0, 300.0, 400.0])
def test_the_end_of_a_ramp_beside_a_lever_arm_has_no_spike(acceleration):
    """What pulls grows with the square of the time, and what swings ends at once: a cusp.

    Up to 300 °/s, an arm of 6 cm outwards and 2 cm across; degrees and seconds.
    """
    ways = np.arange(-200, 3800) / 100
    for start in np.arange(0.0, 36.0, 4.0) + 0.003:  # at any place in an interval
        values = rest(4000)
        rate = np.radians(np.clip((ways - start) * acceleration, 0.0, 300.0))
        ramp = (rate > 0) & (rate < np.radians(300.0))
        values[:, 0] += -0.06 * rate**2 - 0.02 * np.radians(acceleration) * ramp
        values[:, 1] += -0.02 * rate**2 + 0.06 * np.radians(acceleration) * ramp
        values[:, 5] += rate
        assert not places(values)


def test_gravity_while_the_case_is_tilted_over_has_no_spike_at_its_turning_point():
    values = rest(60_000)
    tops = np.arange(500, 59_500, 500)
    speeds = np.linspace(0.5, 3.0, len(tops))  # rad/s
    for top, speed in zip(tops, speeds, strict=True):
        angle = np.clip(speed * INTERVAL * np.arange(-200, 200), -np.pi / 2, np.pi / 2)
        values[top - 200 : top + 200, 1] += GRAVITY * np.cos(angle)
    assert places(values) == []
    spoilt = tops[::4]
    values[spoilt, 1] -= 2.0
    assert places(values) == [(1, first, first + 1) for first in spoilt]


def test_a_spike_in_an_oscillation_is_found_if_it_is_a_gross_one():
    values = turn()
    time = np.arange(len(values)) * INTERVAL
    values[1200:4500, 3] += 0.01 * np.sin(2 * np.pi * 20 * time[1200:4500])
    assert places(values) == []
    values[3000, 3] += 0.5
    assert places(values) == [(3, 3000, 3001)]


def test_what_lasts_longer_is_no_spike():
    values = rest(3000)
    values[1000:1004, 0] += 1.0
    values[2000:, 1] += 1.0  # a step
    assert places(values) == []


def test_a_knock_is_no_spike():
    values = rest(3000)
    ringing = np.exp(-np.arange(12) / 3) * np.cos(2 * np.pi * 0.3 * np.arange(12))
    for channel, size in enumerate((1.0, -0.6, 2.0, 0.02, 0.03, 0.01)):
        values[1500:1512, channel] += size * ringing
    assert places(values) == []


def test_one_record_spoilt_in_several_channels_is_found():
    values = rest(3000)
    values[1500, [0, 2, 4]] += [1.0, -3.0, 0.1]
    assert places(values) == [(0, 1500, 1501), (2, 1500, 1501), (4, 1500, 1501)]


def test_motion_by_hand_is_silent():
    generator = np.random.default_rng(8)
    values = rest(20_000)
    for start in range(1000, 18_000, 3000):
        # Jerks of a hand: noise of 5 Hz and heavy tails, in all channels.
        jerks = generator.standard_t(4.0, (1200, 6)) * np.array([2.0] * 3 + [0.5] * 3)
        kernel = np.hanning(7) / np.hanning(7).sum()
        for channel in range(6):
            moved = np.convolve(jerks[:, channel], kernel, mode="same") * np.hanning(1200)
            values[start : start + 1200, channel] += moved
    assert places(values) == []


def test_taps_between_motions_by_hand_are_none_and_a_gross_reading_is_one():
    """Put down and tapped: three readings of one gyro, or one reading of two accelerometers."""
    values = rest(20_000)
    phase = np.linspace(0, 2 * np.pi, 400)
    for start in range(1000, 18_000, 3000):
        values[start : start + 400, 3:] += 0.5 * np.outer(1 - np.cos(phase), [1, -0.5, 0.7])
        jerks = np.random.default_rng(start).standard_normal((400, 6))
        values[start : start + 400] += jerks * [0.5, 0.5, 0.5, 0.05, 0.05, 0.05]
    values[2500:2503, 5] -= np.array([0.5, 1.0, 0.55]) * 70 * NOISE[5]
    values[5500, [0, 2]] += [-8.5 * NOISE[0], -9 * NOISE[2]]
    assert places(values) == []
    values[8500, 1] += 30.0
    assert places(values) == [(1, 8500, 8501)]


def test_coarse_counts_are_silent():
    generator = np.random.default_rng(9)
    step = 8 * NOISE
    values = np.rint((rest(40_000) + generator.normal(size=(40_000, 6)) * NOISE) / step) * step
    assert places(values, quantum=step) == []


def test_beside_masked_readings_nothing_is_judged():
    values = turn()
    values[1350:4450, 5] = np.nan  # from a ramp to a ramp
    assert places(values) == []


def test_the_chance_is_that_of_gaussian_readings():
    assert chance(7.5) < 1e-4
    assert chance(4.0) == 1.0


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    readings = [rest(200_000, seed), turn(seed), tumble(seed)]
    assert [places(values) for values in readings] == [[], [], []]


def test_where_the_rate_of_a_change_of_position_rises_and_falls_at_once_there_is_no_spike():
    """By four sigma a reading, as a MEMS at 25 °/s²: its top was masked in one log of six."""
    values, rise = rest(60_000), np.arange(40)
    tops = np.arange(500, 59_000, 300)
    for top in tops:
        values[top - 39 : top + 40, 4] += 4 * NOISE[4] * np.append(rise, rise[-2::-1])
    assert len(places(values)) <= 0.01 * len(tops)
    values[tops[::10], 4] += 30 * NOISE[4]
    assert set(tops[::10]) <= {first for _, first, _ in places(values)}


def test_a_log_without_time_is_not_judged():
    values = rest(100)
    values[50] += GRAVITY
    one = piece(values)
    assert list(Spikes().detect(one, log(one))) == []
