"""An oscillation in noise: its numbers within their sigmas, and silence where there is none."""

import numpy as np
import pytest

from inertial.estimation.periodic_in_time import pooled, strongest, without_line


def test_frequency_and_amplitude_come_back_within_their_sigmas():
    rng = np.random.default_rng(2)
    time = np.arange(3390) / 100
    pulls = []
    for phase in np.linspace(0, 3, 40):
        record = 0.01 * np.sin(2 * np.pi * 20.013 * time + phase) + 1e-3 * time
        line = strongest(record + 3.5e-5 * rng.standard_normal(len(time)), 100.0, 2.0)
        assert line is not None
        pulls.append((line.frequency - 20.013) / line.sigma_frequency)
        pulls.append((line.amplitude - 0.01) / line.sigma_amplitude)
    assert 0.75 < np.std(pulls) < 1.25
    assert abs(np.mean(pulls)) < 0.5


@pytest.mark.slow
def test_in_noise_the_p_values_are_those_of_chance():
    rng = np.random.default_rng(4)
    lines = [strongest(rng.standard_normal(2000), 100.0, 2.0) for _ in range(300)]
    p_values = np.array([line.p_value for line in lines if line is not None])
    assert len(p_values) == 300
    assert 4 <= (p_values < 0.05).sum() <= 28  # 15 are expected
    assert (p_values < 0.001).sum() <= 2


def test_a_record_without_its_line_is_the_rest():
    time = np.arange(1000) / 100
    split = without_line(3 + 0.2 * np.cos(2 * np.pi * 7 * time), 100.0, 7.0)
    assert abs(split.amplitude - 0.2) < 1e-3
    assert np.abs(split.less(split.amplitude)).max() < 1e-3


@pytest.mark.parametrize("slow", [1 / 20, 1 / 6, 0.31, 0.9])
def test_sidelobes_of_what_swings_below_the_search_are_no_lines(slow):
    """A record of six seconds that swings by a hundred sigma, and a line of three in it."""
    rng, time = np.random.default_rng(6), np.arange(590) / 100
    swing = 100 * np.sin(2 * np.pi * slow * time + 0.7)
    records = [swing + rng.standard_normal(len(time)) for _ in range(2)]
    alone = strongest(records[0], 100.0, 2.0)
    assert alone is None or alone.p_value > 1e-4
    frequencies, _, log_p = pooled(records, [100.0, 100.0], 2.0)
    assert log_p.min() + np.log(len(frequencies)) > np.log(1e-4)
    line = strongest(records[0] + 3 * np.sin(2 * np.pi * 30.07 * time), 100.0, 2.0)
    assert line is not None and line.p_value < 1e-6
    assert abs(line.frequency - 30.07) < 4 * line.sigma_frequency


@pytest.mark.parametrize("seconds", [0.5, 1.0, 3.0])
def test_an_oscillation_that_decays_is_no_sidelobe(seconds):
    """As a table rings when it has reached its rate: over before a taper lets it in."""
    rng, time = np.random.default_rng(7), np.arange(590) / 100
    ringing = 5 * np.exp(-time / seconds) * np.sin(2 * np.pi * 8 * time)
    line = strongest(ringing + rng.standard_normal(len(time)), 100.0, 2.0)
    assert line is not None and line.p_value < 1e-6 and abs(line.frequency - 8) < 0.3
