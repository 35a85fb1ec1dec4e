"""Overlapping Allan deviation: published values, theory, and the rule for gaps and shares."""

import numpy as np
import pytest
from noise_simulation import noise

from inertial.estimation import allan as module
from inertial.estimation.allan import AllanSums, factors_up_to, pooled_degrees
from inertial.estimation.noise_model import NoiseModel

WHITE = NoiseModel(white_noise=1.0)


def allan(stretches, interval, factors=None, models=None):
    """The overlapping Allan deviation of stretches (n, c) that are in memory."""
    sums = AllanSums(stretches[0].shape[1], factors)
    for stretch in stretches:
        sums.add(stretch)
        sums.end()
    return sums.result(interval, models)


def nist_series() -> np.ndarray:
    """The 1000 points of NIST SP 1065, section 12.4: n' = 16807 n mod (2³¹ − 1)."""
    number, values = 1234567890, []
    for _ in range(1000):
        values.append(number / 2147483647)
        number = 16807 * number % 2147483647
    return np.array(values)[:, None]


def by_definition(rates: np.ndarray, factor: int) -> float:
    """Means of every window, and half of the mean square of their differences."""
    means = np.convolve(rates, np.full(factor, 1 / factor), "valid")
    return float(np.sqrt(np.mean((means[factor:] - means[:-factor]) ** 2) / 2))


def test_values_of_nist_sp_1065():
    """Table 31 of NIST SP 1065: overlapping Allan deviation of the 1000 points."""
    found = allan([nist_series()], 1.0, np.array([1, 10, 100]))
    published = [2.922319e-01, 9.159953e-02, 3.241343e-02]
    np.testing.assert_allclose(found.deviation[:, 0], published, rtol=3e-7)


def test_degrees_of_freedom_of_white_noise_in_nist_sp_1065():
    """Table 5 of NIST SP 1065: [3(N − 1)/(2m) − 2(N − 2)/N] · 4m²/(4m² + 5) with N phases."""
    phases = 1001
    for m in (2, 10, 50):
        published = 3 * (phases - 1) / (2 * m) - 2 * (phases - 2) / phases
        published *= 4 * m**2 / (4 * m**2 + 5)
        assert pooled_degrees(m, np.array([1000]), WHITE) == pytest.approx(published, rel=0.02)


@pytest.mark.parametrize(
    ("term", "exponent"),
    # Greenhall and Riley, PTTI 2003, by allantools 2024.6: edf_greenhall(…, d=2, N=1001)
    [
        ("quantisation", {10: 507.1731, 100: 440.2065, 200: 372.9061}),
        ("white_noise", {100: 12.81493, 200: 5.407201}),
        ("bias_instability", {10: 114.66868, 100: 9.948043, 200: 4.132242}),
        ("random_walk", {10: 91.03844, 100: 7.753683, 200: 3.141540}),
    ],
)
def test_degrees_of_freedom_of_greenhall_and_riley(term, exponent):
    for factor, published in exponent.items():
        model = NoiseModel(**{term: 3.0})
        found = pooled_degrees(factor, np.array([1000]), model, 0.01)
        assert found == pytest.approx(published, rel=0.006)


def test_it_is_the_definition_whatever_the_pieces(monkeypatch):
    monkeypatch.setattr(module, "BLOCK", 64)  # so that the running sums are moved many times
    chance = np.random.default_rng(1)
    rates = 9.8 + np.cumsum(chance.standard_normal((3000, 2)), axis=0) * [0.1, 1e-6]
    factors = np.array([1, 2, 7, 60, 700])
    sums = AllanSums(2, factors)
    for piece in np.split(rates, [1, 2, 500, 501, 2900]):
        sums.add(piece)
    sums.end()
    found = sums.result(0.01)
    for i, factor in enumerate(factors.tolist()):
        for channel in range(2):
            expected = by_definition(rates[:, channel], factor)
            assert found.deviation[i, channel] == pytest.approx(expected, rel=1e-8)
    np.testing.assert_array_equal(found.terms, 3000 - 2 * factors + 1)
    np.testing.assert_allclose(found.tau, factors * 0.01)


def test_stretches_are_pooled_by_their_terms_and_no_average_spans_a_gap():
    """A jump between two stretches is in none of the differences."""
    chance = np.random.default_rng(2)
    one, two = chance.standard_normal((400, 1)), chance.standard_normal((1000, 1)) + 1e3
    factors = np.array([1, 10, 100, 101, 250, 251])
    found = allan([one, two], 1.0, factors)
    weights = [np.where(factors <= n // 4, n - 2 * factors + 1, 0) for n in (400, 1000)]
    np.testing.assert_array_equal(found.factor, [1, 10, 100, 101, 250])  # a quarter of 1000
    np.testing.assert_array_equal(found.stretches, [2, 2, 2, 1, 1])
    for i, factor in enumerate(found.factor.tolist()):
        own = [
            (weight[i], by_definition(part[:, 0], factor) ** 2)
            for part, weight in zip((one, two), weights, strict=True)
            if weight[i]
        ]
        expected = np.sqrt(sum(w * square for w, square in own) / sum(w for w, _ in own))
        assert found.deviation[i, 0] == pytest.approx(expected, rel=1e-8)


def test_long_averages_start_at_every_stride_only(monkeypatch):
    monkeypatch.setattr(module, "MAX_EXACT_FACTOR", 100)
    monkeypatch.setattr(module, "STRIDE", 4)
    rates = np.random.default_rng(3).standard_normal((4001, 1))
    found = allan([rates], 1.0, np.array([100, 202]))
    np.testing.assert_array_equal(found.factor, [100, 200])
    assert found.deviation[0, 0] == pytest.approx(by_definition(rates[:, 0], 100), rel=1e-9)
    means = np.convolve(rates[:4000, 0], np.full(200, 1 / 200), "valid")[::4]
    expected = np.sqrt(np.mean((means[50:] - means[:-50]) ** 2) / 2)
    assert found.deviation[1, 0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("coefficients", "variance"),
    [
        ({"quantisation": 0.3}, lambda tau: 3 * 0.3**2 / tau**2),
        ({"white_noise": 0.5}, lambda tau: 0.5**2 / tau),
        ({"bias_instability": 2.0}, lambda tau: 2 * np.log(2) / np.pi * 4.0 + 0 * tau),
        ({"random_walk": 0.5}, lambda tau: 0.25 * tau / 3),
        ({"ramp": 0.01}, lambda tau: 0.01**2 * tau**2 / 2),
    ],
)
def test_terms_of_ieee_952(coefficients, variance):
    """The Allan variance of simulated noise is the standard's, within what chance allows."""
    chance = np.random.default_rng(4)
    interval = 0.5
    white = {"white_noise": 1.0} if "quantisation" in coefficients else {}
    stretches = [noise(8192, interval, chance, **coefficients, **white)[:, None] for _ in range(20)]
    factors = np.array([4, 16, 64, 256])
    model = NoiseModel(**coefficients, **white)
    found = allan(stretches, interval, factors, [model])
    expected = variance(found.tau) + (1 / found.tau if white else 0)
    np.testing.assert_allclose(model.allan_variance(found.tau), expected, rtol=1e-12)
    pulls = (found.deviation[:, 0] ** 2 / expected - 1) / np.sqrt(2 / found.degrees[:, 0])
    assert np.abs(pulls).max() < 3.5 or "ramp" in coefficients
    if "ramp" in coefficients:
        np.testing.assert_allclose(found.deviation[:, 0] ** 2, expected, rtol=1e-8)


def test_the_interval_holds_with_one_sigma():
    """Of 600 stretches: 68.3 %, also at the longest, with few degrees of freedom."""
    chance = np.random.default_rng(5)
    coefficients = {"white_noise": 1.0, "random_walk": 0.05}
    rates = np.array([noise(512, 1.0, chance, **coefficients) for _ in range(600)]).T
    model = NoiseModel(**coefficients)
    found = allan([rates], 1.0, np.array([1, 8, 32, 128]), [model] * 600)
    true = np.sqrt(model.allan_variance(found.tau))[:, None]
    share = np.mean((found.lower < true) & (true < found.upper), axis=1)
    # 3.3 sigma of 600 draws
    np.testing.assert_allclose(share, 0.683, atol=3.3 * np.sqrt(0.683 * 0.317 / 600))


def test_factors_are_evenly_spaced_by_their_logarithms():
    factors = factors_up_to(1000, 10)
    assert factors[0] == 1 and factors[-1] == 1000
    large = factors[factors > 50]
    np.testing.assert_allclose(large[1:] / large[:-1], 10**0.1, rtol=0.02)


@pytest.mark.parametrize(
    ("coefficients", "density"),
    [
        ({"quantisation": 0.3}, lambda f: 0.09 * (2 * np.pi * f) ** 2 * 0.01),
        ({"white_noise": 0.5}, lambda f: 0.25 + 0 * f),
        ({"bias_instability": 2.0}, lambda f: 4.0 / (2 * np.pi * f)),
        ({"random_walk": 0.5}, lambda f: 0.25 / (2 * np.pi * f) ** 2),
    ],
)
def test_densities_of_ieee_952(coefficients, density):
    """Far below half the sampling rate, where neither the mean nor folding counts."""
    frequency = np.array([1e-3, 0.01, 0.1, 0.5])
    found = NoiseModel(**coefficients).density(frequency, 0.01)
    np.testing.assert_allclose(found, density(frequency), rtol=1e-3)
