"""An axis that changes its sign within a log is found to the record."""

from dataclasses import replace

import numpy as np
import pytest
from on_a_table import BIAS, RAMP, askew, profile, recorded, rest, tumble, turn
from recorded_by_hand import INTERVAL, NOISE, assert_told

from inertial.detectors.misread_axes_and_signs import (
    AxisSwap,
    AxisSwapOfGyros,
    SignFlip,
    SignFlipOfGyros,
)
from inertial.signal.detector import Windows

EACH = (AxisSwap(), AxisSwapOfGyros(), SignFlip(), SignFlipOfGyros())


def found(values):
    one, log = recorded(values)
    seen = []
    for detector in EACH:
        events = list(detector.detect(one, log))
        for event in events:
            assert_told(detector, event, "log")
        seen += [(detector.name, detector.sensor, event.first, event.after) for event in events]
        one = one.without(events)
    return seen


def flipped(values, channel, first, after):
    values = values.copy()
    values[first:after, channel] *= -1
    return values


@pytest.mark.parametrize("samples", [5, 10, 1000])
@pytest.mark.parametrize("channel", [0, 2])
def test_a_flipped_accelerometer_is_found(channel, samples):
    values = flipped(rest(3000), channel, 1500, 1500 + samples)
    assert found(values) == [("sign_flip", "accel", 1500, 1500 + samples)]


@pytest.mark.parametrize("samples", [5, 10, 1000])
@pytest.mark.parametrize("about", [0, 1, 2])
def test_a_flipped_gyro_is_found_while_the_table_turns(about, samples):
    values = flipped(turn(about=about), 3 + about, 2500, 2500 + samples)
    assert found(values) == [("sign_flip", "gyro", 2500, 2500 + samples)]


def test_its_words_name_the_axis_and_the_numbers():
    values = flipped(rest(3000), 2, 1500, 3000)
    one, log = recorded(values)
    (event,) = SignFlip().detect(one, log)
    words = SignFlip().describe(event, "up.asc")
    assert "z reads −z" in words.sentence
    assert "on z would be −9.75" in words.consequence
    assert "in place of 9.75" in words.consequence


def test_two_signs_that_cancel_are_found_too():
    values = flipped(flipped(rest(3000), 0, 1000, 2000), 2, 1000, 2000)
    assert found(values) == [("sign_flip", "accel", 1000, 2000)]


def test_a_sign_of_nothing_cannot_be_seen():
    values = rest(3000)
    values[:, 1] -= values[:, 1].mean()
    assert found(flipped(values, 1, 1000, 2000)) == []
    assert found(flipped(rest(3000), 5, 1000, 2000)) == []  # a gyro at rest


def test_how_small_a_reading_may_be():
    # Twenty times the noise is enough, four times is not.
    for times, seen in ((20, 1), (4, 0)):
        values = rest(3000)
        values[:, 1] += times * NOISE[1] - values[:, 1].mean()
        assert len(found(flipped(values, 1, 1000, 2000))) == seen


def test_an_oscillation_is_none():
    values = rest(20_000)
    time = np.arange(20_000) / 100
    for channel, frequency in ((3, 20.0), (4, 1.3), (0, 49.0), (2, 5.0)):
        values[:, channel] += 300 * NOISE[channel] * np.sin(2 * np.pi * frequency * time)
    assert found(values) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    readings = [rest(200_000, seed, up) for up in range(3)]
    readings += [turn(seed), tumble(seed), askew(turn(seed)), askew(tumble(seed))]
    assert [found(values) for values in readings] == [[]] * 7


def test_a_lever_arm_that_pulls_as_far_below_zero_as_the_bias_is_above_turns_no_sign():
    """Two good turns were lost to it: the table begins to turn at that record."""
    values, speeding = turn(), np.gradient(profile())
    values[:, 0] -= (
        2 * BIAS[0] * np.where(np.abs(speeding) > RAMP * INTERVAL / 4, np.sign(speeding), 0)
    )
    assert found(values) == []


@pytest.mark.parametrize(
    ("channel", "first", "after"),
    [(3, 0, 2500), (3, 2500, 5800), (1, 0, 2500), (1, 2500, 5800)],
)
def test_gravity_tells_which_side_of_a_lasting_change_is_reversed(channel, first, after):
    values = tumble()
    one, log = recorded(flipped(values, channel, first, min(after, len(values))))
    number = round(1 / INTERVAL)
    whole = len(values) // number * number
    means = one.values[:whole].reshape(-1, number, 6)
    time = one.time[:whole].reshape(-1, number).mean(axis=1)
    windows = Windows(means.mean(axis=1), means.var(axis=1), time, np.full(len(time), np.nan))
    log = replace(log, windows=windows)
    detector = (SignFlip(), SignFlipOfGyros())[channel >= 3]
    (event,) = detector.detect(one, log)
    assert (event.first, event.after) == (first, min(after, len(values)))
    assert tuple(event.channels) == (channel,)  # and not the other sensor
    assert_told(detector, event, "log")
    words = detector.describe(event, "log").sentence
    assert ("before line 2501" in words) is (first == 0)
