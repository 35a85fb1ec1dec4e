"""A reading that is off at one phase of a period is found with phase and period, weak or not."""

import re
from dataclasses import replace

import numpy as np
import pytest
from on_a_table import carried, recorded, rest, tumble, turn
from recorded_by_hand import COUNT, GRAVITY, INTERVAL, NOISE, assert_told, piece, stamps
from recorded_by_hand import log as recorded_log

from inertial.detectors.disturbances import PeriodicGlitch
from inertial.detectors.spike import Spikes
from inertial.signal.phase_folding import Folded, glitches


def folded(*stretches, interval=INTERVAL):
    """What is found in stretches of one clock, each with its stamps."""
    sums = Folded(interval)
    for time, values in stretches:
        sums.add(time, values)
    return glitches({"clock": sums})["clock"]


def spoilt(values, time, period, phase, channel, size):
    """The record at this phase of every period reads `size` too much."""
    at = np.mod(time - phase + INTERVAL / 2, period) < INTERVAL - 1e-9
    values = values.copy()
    values[at, channel] += np.rint(size / COUNT[channel]) * COUNT[channel]
    return values, at


@pytest.mark.parametrize(
    ("period", "phase", "seconds"),
    [(1.0, 0.010, 60), (0.5, 0.37, 60), (0.1, 0.05, 30), (10.0, 3.3, 600), (60.0, 31.4, 900)],
)
@pytest.mark.parametrize("sigma", [4.0, 400.0])
def test_period_and_phase_are_found_and_nothing_else(period, phase, seconds, sigma):
    """Of four sigma each is no spike; all of a minute are 31 sigma, of which three count: 18."""
    values, time = rest(round(seconds / INTERVAL)), stamps(round(seconds / INTERVAL))
    values, at = spoilt(values, time, period, phase, 4, sigma * NOISE[4])
    (found,) = folded((time, values))
    assert (found.sensor, found.channel, found.period) == ("gyro", 4, period)
    assert found.phase == pytest.approx(phase, abs=1e-6) and found.width == pytest.approx(INTERVAL)
    assert found.size == pytest.approx(sigma * NOISE[4], abs=4 * NOISE[4] / np.sqrt(at.sum()))
    assert np.array_equal(found.falls_on(time), at)
    assert found.p_value < 1e-4


def of_a_third_of_a_second(number, share, begin):
    """Excerpts of turns at 10 °/s about x, y, z, both ways, each across a whole second."""
    excerpts = []
    for k in range(number):
        time = begin + 37.0 * k - 0.02 + stamps(33)
        truth = np.tile([0.07, 0.0, 0.0, 1e-6, -2e-6, 1e-6], (33, 1))
        truth[:, 2] += GRAVITY
        truth[:, 3 + k // 2 % 3] += np.radians(10) * (-1) ** k
        values = carried(truth, k)
        at = np.mod(time + INTERVAL / 2, 1.0) < INTERVAL
        at = np.roll(at, 1)  # stamped .010
        values[at, 3:] *= 1 + share
        excerpts.append((time, values))
    return excerpts


@pytest.mark.parametrize("begin", [100.0, 558_350.0000236])
def test_six_excerpts_of_turns_show_the_share_by_which_their_gyros_are_off(begin):
    """As WHU's: 0.15 % of 10 °/s is seven times the noise of a reading, once in each log."""
    excerpts = of_a_third_of_a_second(6, 0.0015, begin)
    (found,) = folded(*excerpts)
    assert (found.sensor, found.channel) == ("gyro", None)
    assert (found.period, found.others) == (1.0, (0.5,))  # half a second later nothing is recorded
    assert found.phase == pytest.approx(0.010, abs=1e-6)
    assert found.size == pytest.approx(0.0015, abs=4 * NOISE[3] / np.radians(10) / np.sqrt(6))
    assert found.p_value < 1e-4
    assert folded(*of_a_third_of_a_second(6, 0.0, begin)) == ()


def test_motions_that_repeat_at_a_period_are_none():
    """A tumble every 50 s: at its peak a reading is 0.04 sigma above those beside it, each time."""
    time = 0.02 * np.arange(round(200 * 50 / 0.02))
    within = np.mod(time, 50.0) - 40.0
    rate = np.where((within > 0) & (within < 5), 1 - np.cos(2 * np.pi * within / 5), 0.0)
    random = np.random.default_rng(8)
    values = random.normal(0, [2e-3] * 3 + [3e-4] * 3, (len(time), 6))
    values[:, 3] += np.radians(18) * rate
    assert folded((time, values), interval=0.02) == ()


def test_its_readings_are_masked_and_no_spikes_any_more():
    time = stamps(6000)
    values, at = spoilt(rest(6000), time, 1.0, 0.25, 3, 40 * NOISE[3])
    one, log = recorded(values)
    assert len(list(Spikes().detect(one, log))) == at.sum() == 60
    log = replace(log, glitches=folded((time, values)))
    events = list(PeriodicGlitch().detect(one, log))
    assert [event.first for event in events] == np.flatnonzero(at).tolist()
    assert list(Spikes().detect(one.without(events), log)) == []
    for event in events[:2]:
        assert_told(PeriodicGlitch(), event, "log")


@pytest.mark.parametrize("rate", [100.0, 102.4])
def test_its_words_state_by_how_much_it_moves_a_mean(rate):
    """Where the rate does not divide the second, its phase falls on one record or on two."""
    n = round(120 * rate)
    time, clean = np.arange(n) / rate, rest(n)
    values = clean.copy()
    values[np.diff(np.floor(time - 0.3), prepend=-1.0) > 0, 3] += 40 * NOISE[3]
    one = piece(values, time)
    log = recorded_log(one, increments=True, glitches=folded((time, values), interval=1 / rate))
    events = [("log", event) for event in PeriodicGlitch().detect(one, log)]
    told = PeriodicGlitch().describe_many(events)
    moved, unit, sigmas = re.search(
        r"move every mean by (\S+) (\S+): (\S+) times the noise", told.consequence
    ).groups()
    expected = float(np.degrees(values[:, 3].mean() - clean[:, 3].mean()))
    assert unit == "°/s" and float(moved) == pytest.approx(expected, rel=0.06)
    # 1.2 records in a hundred and 40 sigma each: of 12,000 readings the mean has 1/√12,000 sigma.
    assert float(sigmas) == pytest.approx(40 / rate * np.sqrt(n), rel=0.06)


def test_its_words_state_by_how_much_it_moves_a_scale_factor():
    """Of 33 readings in each turn one is 0.15 % too large: their sum by 45 ppm."""
    excerpts = of_a_third_of_a_second(6, 0.0015, 100.0)
    (glitch,) = folded(*excerpts)
    events = []
    for number, (time, values) in enumerate(excerpts):
        one = piece(values, time)
        log = recorded_log(one, increments=True, glitches=(glitch,))
        events += [(f"log {number}", event) for event in PeriodicGlitch().detect(one, log)]
    told = PeriodicGlitch().describe_many(events)
    assert "6 samples in" in told.sentence
    ppm = float(re.search(r"of all axes (\S+) ppm too large", told.consequence)[1])
    assert ppm == pytest.approx(0.0015 / 33 * 1e6, rel=0.25)  # 22 to 28 counts, as WHU's


@pytest.mark.parametrize("frequency", [20.0, 10.0, 1.0, 37.0])
@pytest.mark.parametrize("times", [0.3, 3.0, 30.0])
def test_an_oscillation_in_step_with_the_clock_is_none(frequency, times):
    time = stamps(12_000)
    values = rest(12_000)
    values[:, 3] += times * NOISE[3] * np.sin(2 * np.pi * frequency * time + 0.3)
    assert folded((time, values)) == ()


@pytest.mark.parametrize("draw", [67, 158, 191, 217, 315, 339, 774, 784, 1480, 3716])
def test_the_highest_phase_of_a_weak_oscillation_is_none(draw):
    """Of 0.25 sigma in 30 s: in 1 % of draws one phase is by chance twice as far off as others."""
    random = np.random.default_rng([draw, 7])
    time = stamps(3000)
    values = random.normal(0, 1, (3000, 6)) * NOISE
    values[:, 3] += 0.25 * NOISE[3] * np.sin(2 * np.pi * 20 * time + random.uniform(0, 6.28))
    assert folded((time, values)) == ()


def test_ramps_at_whole_seconds_are_none():
    """Thirty turns begin and end at whole seconds, each a corner at the same phase."""
    values = turn()
    values = values[: len(values) // 100 * 100]
    stretches = [(stamps(len(values)) + 100.0 * k, turn(k)[: len(values)]) for k in range(30)]
    assert folded(*stretches) == ()


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    readings = [rest(200_000, seed), turn(seed), tumble(seed)]
    assert folded(*((1000.0 * k + stamps(len(v)), v) for k, v in enumerate(readings))) == ()


def test_a_few_spikes_in_step_are_no_period():
    """Three large ones at one phase by chance: no one reading may decide."""
    time = stamps(60_000)
    values = rest(60_000)
    values[[1234, 7234, 31_234], 0] += 1000 * NOISE[0]
    assert folded((time, values)) == ()


@pytest.mark.parametrize("rate", [102.4, 204.8, 250.0])
def test_a_rate_that_does_not_divide_the_second(rate):
    n = round(120 * rate)
    time = np.arange(n) / rate
    values = rest(n)
    at = np.diff(np.floor(time - 0.3), prepend=-1.0) > 0  # the first sample after .300
    values[at, 1] += 20 * NOISE[1]
    (found,) = folded((time, values), interval=1 / rate)
    assert (found.channel, found.period) == (1, 1.0)
    assert 0.3 - 1 / rate <= found.phase <= 0.3 + 2 / rate
    assert (at & found.falls_on(time)).sum() > 0.7 * at.sum()


def test_the_rounding_of_equal_readings_is_none():
    """A tail of one record over and over, stamp and all, as an erased memory is read."""
    tail = [-5.9815e-4, 1.1e-3, -7.3e-4, -1.3316e-4, 2.7e-4, -3.1e-4]
    values = np.vstack([rest(2000), np.tile(tail, (20_000, 1))])
    time = np.append(0.02 * np.arange(2000), np.full(20_000, 4294967.295))
    assert folded((time, values), interval=0.02) == ()


def test_without_stamps_nothing_is_judged():
    assert folded((np.full(1000, np.nan), rest(1000))) == ()
