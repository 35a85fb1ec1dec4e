"""An oscillation is found with frequency, amplitude and edges; noise, ramps and hands are none."""

from dataclasses import replace

import numpy as np
import pytest
from on_a_table import carried, profile, recorded, rest, tumble, turn
from recorded_by_hand import COUNT, INTERVAL, NOISE, assert_told

from inertial.detectors.oscillation import Oscillation
from inertial.signal.spectral_lines import in_windows, lines, windows


def found(values, **of_log):
    one, log = recorded(values, **of_log)
    events = list(Oscillation().detect(one, log))
    for event in events:
        assert_told(Oscillation(), event, "log")
    return events


def ringing(values, channel, frequency, amplitude, first, after):
    """A sine from one record to another, as increments have it: its mean over each interval."""
    time = (np.arange(first, after) - first) * INTERVAL
    phase = 2 * np.pi * frequency
    mean = (np.cos(phase * time) - np.cos(phase * (time + INTERVAL))) / (phase * INTERVAL)
    rung = values.copy()
    rung[first:after, channel] += np.rint(amplitude * mean / COUNT[channel]) * COUNT[channel]
    return rung


@pytest.mark.parametrize("times", [6, 30, 1000])
@pytest.mark.parametrize("frequency", [5.3, 20.0, 37.0, 46.0])
def test_frequency_amplitude_and_edges_come_back(frequency, times):
    values = ringing(rest(8000), 4, frequency, times * NOISE[4], 1234, 5678)
    # As increments read it: at 46 Hz seven times less than the rate itself.
    seen = times * np.sinc(frequency * INTERVAL)
    (event,) = found(values)
    assert event.channel == 4
    tone = event.facts.tone
    assert tone.frequency == pytest.approx(frequency, abs=0.002)
    assert tone.amplitude == pytest.approx(times * NOISE[4], rel=0.05)
    within = 2 if seen > 5 else 8
    assert abs(event.first - 1234) <= within
    assert abs(event.after - 5678) <= within
    assert event.p_value < 1e-4


def test_what_it_does_to_an_angle_is_told_as_s0_has_it():
    # S0, figure 5-14: 20 Hz and 0.01 rad/s swing by 7.96e-5 rad, 25.33 ppm of 180°.
    values = ringing(turn(about=0), 3, 20.0, 0.01, 1300, 4300)
    (event,) = found(values)
    words = Oscillation().describe(event, "x.asc")
    assert "gyro x oscillates at 20.00 Hz by 0.57 °/s" in words.sentence
    assert "while the IMU turns, and not at rest" in words.sentence
    assert "80.00 or 120.00 Hz cannot be distinguished" in words.sentence
    assert "swings by 0.00456°: at most" in words.consequence  # 7.96e-5 · 180/π
    assert "13 ppm of a turn of 360°, 25 ppm of one of 180°" in words.consequence


def session(still, *steady):
    """Rests and turns of so many records, one after the other; whether it turns, (n,)."""
    parts = [turn(seed, still=still, steady=n) for seed, n in enumerate(steady, 1)]
    rates = [profile(still=still, steady=n) for n in steady]
    return np.concatenate(parts), np.concatenate(rates) > 0


@pytest.mark.parametrize(
    ("at_rest", "in_turns", "said"),
    [
        (0.0, 0.0400, "by 0.040 m/s², from {s}while the IMU turns, and not at rest."),
        (0.0400, 0.0, "by 0.040 m/s², from {s}at rest, and not while the IMU turns."),
        (0.0400, 0.0400, "by 0.040 m/s², from {s}at rest and while the IMU turns."),
        (
            0.0200,
            0.0400,
            "by 0.040 m/s², from {s}at rest by 0.020 m/s² and while the IMU turns by 0.040 m/s².",
        ),
    ],
)
@pytest.mark.parametrize("still", [700, 1500])
def test_it_is_said_where_it_is_with_the_amplitude_there(at_rest, in_turns, said, still):
    """Six turns of 16 s among rests of 14 or 30 s, over which the stretch of a line reaches."""
    values, turns = session(still, *[1200] * 6)
    time = INTERVAL * np.arange(len(values))
    size = np.where(turns, in_turns, at_rest)
    values[:, 0] += size * np.sinc(37 * INTERVAL) * np.sin(2 * np.pi * 37 * time)
    events = found(values)
    longest = max(events, key=lambda event: event.after - event.first)
    words = Oscillation().describe(longest, "log").sentence
    between = words.split("from ")[1].split(" s, ")[0]
    assert said.format(s=between + " s, ") in words
    for event in events:
        assert event.size == pytest.approx(max(at_rest, in_turns), rel=0.05)


def test_other_axes_in_step_are_named_with_their_part():
    values = rest(6000)
    for channel, amplitude in ((3, 0.01), (4, 2.4e-4), (0, 8e-3)):
        values = ringing(values, channel, 20.0, amplitude, 1000, 5000)
    (event,) = found(values)
    assert event.channel == 3
    others = dict(event.facts.tone.others)
    assert set(others) == {0, 4}
    assert others[4] == pytest.approx(2.4e-4, rel=0.03)
    assert others[0] == pytest.approx(8e-3, rel=0.03)
    words = Oscillation().describe(event, "log")
    assert ", at rest." in words.sentence and "hand" not in words.action
    turning = replace(event, facts=replace(event.facts, turning=1.0))
    assert "it may be the hand that shakes" in Oscillation().describe(turning, "log").action


def test_an_oscillation_through_a_gap_and_lost_samples_keeps_its_phase():
    values = ringing(rest(8000), 3, 20.3, 1e-3, 1000, 7000)
    kept = np.ones(8000, bool)
    kept[3000:4197] = False
    kept[np.random.default_rng(4).choice(8000, 300, replace=False)] = False
    one, log = recorded(values)
    fields = {name: getattr(one, name)[kept] for name in ("line", "time", "values")}
    fields |= {name: getattr(one, name)[kept] for name in ("status", "temperature")}
    less = one.__class__(record=np.arange(kept.sum()), first=0, after=int(kept.sum()), **fields)
    (event,) = Oscillation().detect(less, log)
    assert event.facts.tone.frequency == pytest.approx(20.3, abs=0.002)
    assert abs(event.from_s - 10.0) <= 0.04
    assert abs(event.to_s - 69.99) <= 0.04


def test_a_line_in_a_log_of_thirty_records_is_found():
    # The pieces of a real campaign that tests/test_recordings.py reads are that short.
    (event,) = found(ringing(rest(31), 5, 44.0, 6e-4, 0, 31))
    assert (event.first, event.after) == (0, 31)
    assert event.facts.tone.frequency == pytest.approx(44.0, abs=0.5)
    assert found(rest(31)) == []


def test_how_weak_an_oscillation_may_be():
    # 45 s of it: half the noise of a reading is always found, a tenth never.
    for seed in range(4):
        assert found(ringing(rest(8000, seed), 0, 13.7, 0.5 * NOISE[0], 1500, 6000))
        assert not found(ringing(rest(8000, seed), 0, 13.7, 0.1 * NOISE[0], 1500, 6000))


def coloured(n, seed):
    """White noise, random walk, and noise that a resonance of some width has passed."""
    generator = np.random.default_rng(seed)
    white = generator.standard_normal((6, n))
    kernel = np.cos(2 * np.pi * 0.13 * np.arange(40)) * np.exp(-np.arange(40) / 6)
    return np.array(
        [
            white[0],
            white[1] + 0.05 * np.cumsum(white[1]),
            np.cumsum(white[2]),
            np.convolve(white[3], kernel, mode="same"),
            np.convolve(white[4], np.hanning(9), mode="same"),
            np.rint(0.3 * white[5]),
        ]
    ).T


@pytest.mark.parametrize("seed", range(3))
def test_coloured_noise_is_silent(seed):
    assert found(coloured(100_000, seed) * NOISE) == []


@pytest.mark.parametrize("noise", [0.05, 0.2, 0.5])
def test_what_rounding_makes_of_a_steady_rate_is_silent(noise):
    # Increments of a rate between two counts go to and fro in a pattern: a line, but not the IMU's.
    for share in (0.1, 0.37, 0.5):
        level = np.full((8000, 6), 163 + share) * COUNT
        assert found(carried(level, 5, noise * COUNT)) == []


def test_motion_by_hand_is_silent():
    generator = np.random.default_rng(8)
    values = rest(20_000)
    for start in range(1000, 18_000, 3000):
        for channel in range(6):
            # Within a second or so a hand trembles at about 9 Hz, without any fixed phase.
            walk = np.cumsum(generator.standard_normal(1200)) * 0.6
            tremor = np.sin(2 * np.pi * 0.09 * np.arange(1200) + walk)
            slow = np.cumsum(generator.standard_normal(1200)) * 0.05
            moved = (slow + 0.3 * tremor) * np.hanning(1200)
            values[start : start + 1200, channel] += moved
    assert found(values) == []


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    readings = [rest(200_000, seed), turn(seed), tumble(seed), turn(seed, steady=600)]
    assert [found(values) for values in readings] == [[]] * 4


def test_the_chance_that_is_told_is_not_too_small():
    # Of 2 million readings of white noise nothing is as clear as a chance of 1 in a campaign.
    generator = np.random.default_rng(12)
    time = in_windows(np.arange(200_000.0))
    for _ in range(10):
        assert list(lines(windows(generator.standard_normal(200_000)), time)) == []


@pytest.mark.parametrize(("frequency", "events"), [(6.0, 0), (25.0, 1)])
def test_the_tremor_of_a_hand_is_motion(frequency, events):
    """Of 6 Hz while the rate changes by as much as it is; a case that rings is no hand's tremor."""
    values = rest(6000)
    time = INTERVAL * np.arange(len(values))
    inside = (time > 5) & (time < 25)
    for channel, phase in ((3, 0.0), (4, 1.0)):
        values[inside, channel] += np.sin(2 * np.pi * time[inside] / 7 + phase)
    values = ringing(values, 3, frequency, 0.1, 700, 2300)
    assert len(found(values)) == events
