"""The shape of noise: none of white noise, that of a filter, and no line in what that leaves."""

import numpy as np
import pytest
from scipy.signal import butter, freqz, lfilter

from inertial.detectors.spike import Channel
from inertial.estimation.periodic_in_time import pooled, strongest
from inertial.estimation.spectrum import WHITE, noise_shape

RATE, SAMPLES = 100.0, 3600


def filtered(seed: int, count: int, corner: float = 15.0, samples: int = SAMPLES):
    """Records of white noise behind a Butterworth filter of the second order."""
    white = np.random.default_rng(seed).standard_normal((count, samples + 500))
    return list(lfilter(*butter(2, corner / (RATE / 2)), white, axis=1)[:, 500:])


def test_white_noise_has_no_shape_whatever_its_levels():
    random = np.random.default_rng(1)
    drawn = [random.standard_normal((12, 600)) * random.uniform(1, 3, (12, 1)) for _ in range(200)]
    assert all(noise_shape(list(each), RATE, 0.5) is WHITE for each in drawn)


def test_it_is_that_of_the_filter_and_a_line_does_not_change_it():
    records = filtered(2, 12)
    time = np.arange(SAMPLES) / RATE
    rung = [record + 5 * np.sin(2 * np.pi * 7 * time + i) for i, record in enumerate(records)]
    at = np.linspace(1, 25, 40)
    true = np.abs(freqz(*butter(2, 15 / (RATE / 2)), at, fs=RATE)[1])
    for own in (records, rung):
        found = noise_shape(own, RATE, 0.5).at(at)
        ratio = found / true
        np.testing.assert_allclose(ratio / np.median(ratio), 1.0, atol=0.15)


@pytest.mark.parametrize("hertz", [0.7, 1.3, 1.312, 2.9])
@pytest.mark.parametrize("amplitude", [0.2, 2.0, 20.0])
def test_a_slow_line_is_no_shape(hertz, amplitude):
    """Where a cell has few bins, of which a line fills half."""
    random, time = np.random.default_rng(5), np.arange(1600) / 50.0
    for _ in range(10):
        phases = random.uniform(0, 2 * np.pi, (6, 1))
        wave = amplitude * np.sin(2 * np.pi * hertz * time + phases)
        shape = noise_shape(list(wave + random.standard_normal(wave.shape)), 50.0, 0.5)
        assert shape.at(hertz) / np.median(shape.amplitude) < 1.4


@pytest.mark.slow
def test_in_filtered_noise_the_p_values_are_about_those_of_chance():
    p_values, together = [], []
    for seed in range(30):
        records = filtered(seed, 10)
        shape = noise_shape(records, RATE, 0.5)
        lines = [strongest(record, RATE, 0.5, (), shape) for record in records]
        p_values += [line.p_value for line in lines if line is not None]
        frequency, _, log_p = pooled(records, [RATE] * len(records), 0.5, shape)
        together.append(log_p.min() + np.log(len(frequency)))
    assert np.mean(np.array(p_values) < 0.01) < 0.04 and np.min(p_values) > 1e-6
    assert np.min(together) > np.log(1e-5)
    # By the noise of the whole band almost every record had a line.
    alone = [strongest(record, RATE, 0.5) for record in filtered(1, 40)]
    assert np.mean([line.p_value < 1e-4 for line in alone]) > 0.5


@pytest.mark.parametrize("slow", ["filter", "average"])
@pytest.mark.parametrize("seed", range(4))
def test_behind_a_slow_filter_there_is_no_line(slow, seed):
    records = filtered(seed, 24, 1.0, 700)
    if slow == "average":
        white = np.random.default_rng(seed).standard_normal((24, 750))
        records = list(lfilter(np.ones(50) / 50, [1], white, axis=1)[:, 50:])
    shape = noise_shape(records, RATE, 0.5)
    frequency, _, log_p = pooled(records, [RATE] * len(records), 2.0, shape)
    assert log_p.min(initial=0.0) + np.log(max(len(frequency), 1)) > np.log(1e-5)
    if slow == "filter":  # of a single record the level between two zeros is not known so well
        assert not any(strongest(record, RATE, 2.0, (), shape) for record in records)


def test_a_line_in_filtered_noise_is_found_with_its_sigmas():
    time, pulls = np.arange(SAMPLES) / RATE, []
    records = filtered(3, 40)
    shape = noise_shape(records, RATE, 0.5)
    for record in records:
        line = strongest(record + 0.25 * np.sin(2 * np.pi * 6.3 * time), RATE, 0.5, (), shape)
        assert line is not None and line.p_value < 1e-4
        pulls.append((line.amplitude - 0.25) / line.sigma_amplitude)
        pulls.append((line.frequency - 6.3) / line.sigma_frequency)
    assert 0.75 < np.std(pulls) < 1.3


@pytest.mark.parametrize("corner", [30.0, 20.0, 10.0, 5.0])
def test_waves_of_filtered_noise_are_no_spikes_and_a_spike_is_one(corner):
    (record,) = filtered(4, 1, corner, samples=300_000)
    record[150_000] += 15 * np.std(record)
    places = np.arange(len(record))
    channel = Channel.of(places, record, places.astype(float), 1e-6, float(np.std(np.diff(record))))
    far = np.abs(channel.off) > 7.5 * channel.scatter
    assert not channel.handled.any() and np.flatnonzero(far).tolist() == [150_000]
