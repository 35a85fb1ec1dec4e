"""Steps larger than stated, or than the noise; what rounding does to a mean is computed here."""

import numpy as np
import pytest
from on_a_table import carried, recorded, rest, tumble, turn
from recorded_by_hand import COUNT, NOISE, assert_told

from inertial.detectors.quantisation import Quantisation
from inertial.signal.scatter import roughness


def found(values, **of_log):
    one, log = recorded(values, **of_log)
    events = list(Quantisation().detect(one, log))
    for event in events:
        assert_told(Quantisation(), event, "log")
    return events


@pytest.mark.parametrize("times", [2, 4, 7])
def test_steps_of_several_counts_are_named_with_their_number(times):
    values = rest(2000)
    values[:, :3] = np.rint(values[:, :3] / (times * COUNT[0])) * times * COUNT[0]
    (event,) = found(values)
    assert event.size == pytest.approx(times * COUNT[0])
    assert event.p_value < 1e-6
    words = Quantisation().describe(event, "log")
    assert "accelerometer x, y, z" in words.sentence
    assert f"{times} times the stated count" in words.sentence


def test_few_readings_far_apart_are_no_larger_steps():
    # 30 lines of a loud channel: the smallest change is many counts by chance.
    values = np.random.default_rng(5).integers(-300, 300, (100, 6)) * COUNT
    assert found(values) == []


@pytest.mark.parametrize("noise", [0.05, 0.2, 0.3])
def test_a_mean_is_off_by_as_much_as_is_told(noise):
    generator = np.random.default_rng(6)
    errors = []
    for level in np.linspace(0, 1, 21):
        readings = np.rint(level + noise * generator.standard_normal(20_000))
        errors.append(abs(readings.mean() - level))
    values = np.full((20_000, 6), np.nan)
    drift = np.repeat(np.linspace(0, 3, 200), 100)
    values[:, 0] = np.rint(drift + noise * generator.standard_normal(20_000)) * COUNT[0]
    one, log = recorded(values)
    (event,) = Quantisation().detect(one, log.__class__(**{**vars(log), "increments": False}))
    told = float(np.exp(-2 * (np.pi * event.facts.noise) ** 2)) / np.pi
    assert event.severity == 2
    # An upper bound: without noise the largest error is half a count, where the first harmonic
    # of the rounding has 1/π.
    assert 0.4 * max(errors) < told < 2.5 * max(errors)


def test_increments_lose_nothing_and_it_is_said():
    level = np.full((20_000, 6), 0.12) * COUNT
    values = carried(level, 7, 0.1 * COUNT)
    accelerometers, gyros = found(values)
    assert (accelerometers.severity, gyros.severity) == (1, 1)
    assert accelerometers.facts.axes == gyros.facts.axes == "xyz"
    assert "good to one step" in Quantisation().describe(gyros, "log").consequence
    assert abs(values[:, 3].sum() - level[:, 3].sum()) < 60 * COUNT[3]  # the noise, not 0.12 × n


def test_the_roughness_of_white_noise_is_as_its_formula_says():
    generator = np.random.default_rng(8)
    for noise in (1.0, 3.0):
        values = np.rint(generator.uniform() + noise * generator.standard_normal(200_000))
        expected = np.sqrt(noise**2 + 1 / 12)
        assert roughness(values) == pytest.approx(expected, rel=0.12)


@pytest.mark.parametrize("seed", range(3))
def test_clean_readings_are_silent(seed):
    assert [found(values) for values in (rest(200_000, seed), turn(seed), tumble(seed))] == [[]] * 3
    assert found(rest(200_000, seed, noise=NOISE / 3)) == []
