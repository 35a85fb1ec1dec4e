"""Sigmas, limits and chances beside closed forms, where there are some."""

from dataclasses import replace

import numpy as np
import pytest
from noise_draws import INTERVAL
from noise_simulation import Array, noise
from scipy.signal import butter, sosfilt
from scipy.stats import binom

from inertial.estimation.multiresolution import Powers
from inertial.estimation.noise_likelihood import Likelihood
from inertial.estimation.noise_terms import _Selection, noise_terms

SAMPLES = 1 << 14
WHITE = frozenset({"white_noise"})


def selection(rates: Array) -> _Selection:
    powers = Powers(1, INTERVAL)
    powers.add(rates[:, None])
    powers.end()
    bins = powers.bins()
    used = np.ones(len(bins.frequency), bool)
    return _Selection(Likelihood.of(bins, powers.lowest(), 0, used))


def test_interval_and_limit_of_white_noise_alone():
    """N²/Δ is the mean of n − 1 squares: chi-squared, so 1.960 and 1.645 of √(2/n) of it."""
    chosen = selection(noise(SAMPLES, INTERVAL, np.random.default_rng(1), white_noise=2.0))
    best = float(np.sqrt(chosen.fit(WHITE).variances[1]))
    relative = np.sqrt(2 / SAMPLES)
    low, high = chosen.interval(WHITE, "white_noise")
    # To second order, the interval of a profile likelihood is longer above than below.
    assert (high - low) / best == pytest.approx(1.960 * relative, rel=0.02)
    upper = chosen.upper(WHITE, "white_noise")
    assert upper**2 / best**2 == pytest.approx(1 + 1.645 * relative, rel=0.05 * relative)


def test_the_slope_in_white_noise_has_the_sigma_of_a_regression():
    """σ = N √(12 / T³)."""
    chosen = selection(noise(SAMPLES, INTERVAL, np.random.default_rng(2), white_noise=2.0))
    fit = chosen.fit(WHITE | {"ramp"})
    expected = 2.0 * np.sqrt(12 / (SAMPLES * INTERVAL) ** 3)
    assert np.sqrt(fit.slope_variance) == pytest.approx(expected, rel=0.03)
    assert abs(fit.slope) < 4 * expected
    half = (chosen.upper(WHITE | {"ramp"}, "ramp") - abs(fit.slope)) / expected
    assert half == pytest.approx(1.645, rel=0.04)


def test_the_slope_in_a_random_walk_is_known_by_its_two_ends():
    """σ = K / √T, the best of all unbiased estimators for Brownian motion with a drift."""
    rates = noise(SAMPLES, INTERVAL, np.random.default_rng(3), white_noise=1e-3, random_walk=1.0)
    names = frozenset({"white_noise", "random_walk", "ramp"})
    fit = selection(rates).fit(names)
    assert np.sqrt(fit.variances[3]) == pytest.approx(1.0, rel=0.03)
    expected = np.sqrt(fit.variances[3] / (SAMPLES * INTERVAL))
    # The highest coefficients do not count for the slope: 1 % of its weight.
    assert np.sqrt(fit.slope_variance) == pytest.approx(expected, rel=0.04)
    half = (selection(rates).interval(names, "ramp")[1] - abs(fit.slope)) / expected
    assert half == pytest.approx(1.960, rel=0.05)


def test_the_chance_of_a_term_that_is_absent():
    """As often below 0.1 as it says, and half of the time of no use at all (boundary)."""
    chance, count = np.random.default_rng(4), 200
    found = [
        selection(chance.standard_normal(1024)).p_value(WHITE | {"random_walk"}, "random_walk")
        for _ in range(count)
    ]
    for level in (0.1, 0.3):
        below = int(np.sum(np.array(found) < level))
        assert binom.ppf(0.002, count, level) <= below <= binom.ppf(0.998, count, level)
    assert np.mean(np.array(found) > 0.49) == pytest.approx(0.5, abs=0.15)


@pytest.mark.parametrize("rise", [-4e-12, 0.0, 4e-12])
def test_rounding_of_the_deviance_is_in_no_chance(rise):
    """The order of a sum of many readings depends on where they lie in memory."""
    names = WHITE | {"quantisation"}
    chosen = selection(np.random.default_rng(5).standard_normal(1024))
    without = chosen.fit(WHITE)
    chosen._fits[names, True] = replace(without, deviance=without.deviance - rise)
    assert chosen.p_value(names, "quantisation") == 0.5


def test_the_deviance_falls_to_a_minimum_where_its_gradient_vanishes():
    rates = noise(
        SAMPLES, INTERVAL, np.random.default_rng(5), white_noise=1.0, bias_instability=2.0,
        random_walk=1.0, ramp=0.1,
    )  # fmt: skip
    likelihood = selection(rates).likelihood
    theta = np.array([1e-5, 1.1, 3.0, 0.7]) / likelihood.unit
    for ramp in (False, True):
        at = likelihood._at(theta, ramp, True)
        for j in range(4):
            step = np.zeros(4)
            step[j] = 1e-4 * theta[j]
            rise = likelihood._at(theta + step, ramp, True).deviance
            fall = likelihood._at(theta - step, ramp, True).deviance
            expected = (rise - fall) / (2 * step[j])
            assert at.gradient[j] == pytest.approx(expected, rel=1e-3, abs=1e-4 / theta[j])


def test_the_information_is_that_of_the_residuals_of_a_slope():
    """½ tr(P Cᵢ P Cⱼ), P = C⁻¹ − C⁻¹ r (rᵀ C⁻¹ r)⁻¹ rᵀ C⁻¹, of the lowest coefficients."""
    rates = noise(SAMPLES, INTERVAL, np.random.default_rng(6), white_noise=1.0, random_walk=1.0)
    likelihood = selection(rates).likelihood
    theta = np.array([1e-5, 1.0, 2.0, 1.5]) / likelihood.unit
    (group,) = likelihood.lowest
    inverse = np.linalg.inv(np.tensordot(theta, group.shapes, 1))
    weighted = inverse @ group.ramp
    projected = inverse - np.outer(weighted, weighted) / (group.ramp @ weighted)
    expected = {
        ramp: np.array(
            [[np.trace(p @ one @ p @ two) / 2 for two in group.shapes] for one in group.shapes]
        )
        for ramp, p in ((False, inverse), (True, projected))
    }
    found = {ramp: likelihood._at(theta, ramp, True).information for ramp in (False, True)}
    scale = 1 / np.sqrt(np.diag(found[False]))
    np.testing.assert_allclose(
        (found[True] - found[False]) * np.outer(scale, scale),
        (expected[True] - expected[False]) * np.outer(scale, scale),
        atol=1e-9,
    )


@pytest.mark.parametrize("corner", [6.0, 12.0])
def test_what_rises_with_the_frequency_and_falls_beyond_the_band_is_no_quantisation(corner):
    """A hand that trembles: the derivative of an angle that follows a hand to so many Hz.

    Its density rises as f² does. That of quantisation, 2 Q² (1 − cos 2πfΔ) / Δ, would be many times
    as large as what is there at half the sample rate.
    """
    chance, rate = np.random.default_rng(4), 1 / INTERVAL
    angle = sosfilt(butter(4, corner, fs=rate, output="sos"), chance.normal(size=SAMPLES))
    white = noise(SAMPLES, INTERVAL, chance, white_noise=1e-3)
    rates = np.diff(angle, prepend=0.0) * 0.2 + white
    powers = Powers(1, INTERVAL)
    powers.add(rates[:, None])
    powers.end()
    (terms,) = noise_terms(powers)
    assert not terms.terms["quantisation"].detected
    measured = np.mean(np.abs(np.fft.rfft(white)[-SAMPLES // 20 :]) ** 2) * INTERVAL / SAMPLES
    quantised = terms.terms["quantisation"].upper ** 2 * 2 * (1 - np.cos(0.9 * np.pi)) / INTERVAL
    assert quantised < 2 * measured
