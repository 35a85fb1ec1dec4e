"""White noise read from a spectrum: right on average, with the stated scatter, blind to lines."""

import numpy as np
import pytest
import scipy.signal

from inertial.estimation.spectrum import band_levels, white_level

BAND = (0.5, 5.0)


@pytest.mark.parametrize("samples", [200, 3400, 30000])
def test_the_level_and_its_sigma_are_those_of_the_noise(samples):
    rng = np.random.default_rng(samples)
    trials = [
        white_level(band_levels(rng.standard_normal((samples, 6)), 100.0, BAND)) for _ in range(40)
    ]
    # σ = 1 per sample at 100 Hz is a random walk of 0.1 per √s.
    levels = np.array([white for white, _ in trials])
    stated = np.mean([sigma for _, sigma in trials])
    scatter = levels.std()
    assert levels.mean() == pytest.approx(0.1, abs=5 * scatter / np.sqrt(levels.size))
    assert scatter == pytest.approx(stated, rel=0.25)


def test_an_oscillation_and_a_drift_are_no_noise():
    rng = np.random.default_rng(1)
    time = np.arange(3400) / 100
    noise = rng.standard_normal((3400, 1))
    disturbed = noise + 300 * np.sin(2 * np.pi * 20.3 * time)[:, None] + 50 * time[:, None]
    clean, _ = white_level(band_levels(noise, 100.0, BAND))
    level, sigma = white_level(band_levels(disturbed, 100.0, BAND))
    assert abs(level[0] - clean[0]) < sigma[0]


@pytest.mark.parametrize("samples", [64, 999, 4096])
def test_a_periodogram_is_that_of_scipy(samples):
    """On a line of any slope, which is none of the noise; two-sided, so half of scipy's."""
    values = np.random.default_rng(5).standard_normal((samples, 2)) + np.arange(samples)[:, None]
    _, density = scipy.signal.periodogram(values, 50.0, "hann", detrend="linear", axis=0)
    found = band_levels(values, 50.0, (0.0, 25.0))
    np.testing.assert_allclose(found, density[1:-1] / 2, rtol=1e-9)
