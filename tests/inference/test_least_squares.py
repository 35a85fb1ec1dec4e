"""Least squares: against a textbook, its chi-squared, its priors, its scatter."""

import numpy as np
import pytest

from inertial.estimation.effect_information import EffectInformation, whitening
from inertial.estimation.least_squares import solve
from inertial.estimation.scatter_and_random_walk import with_scatter

VAGUE = 1e6
# NIST StRD, linear regression, Norris: the data.
NORRIS_X = """
0.2 337.4 118.2 884.6 10.1 226.5 666.3 996.3 448.6 777.0 558.2 0.4 0.6 775.5 666.9 338.0 447.5 11.6
556.0 228.1 995.8 887.6 120.2 0.3 0.3 556.8 339.1 887.2 999.0 779.0 11.1 118.3 229.2 669.1 448.9 0.5
"""
NORRIS_Y = """
0.1 338.8 118.1 888.0 9.2 228.1 668.5 998.5 449.1 778.9 559.2 0.3 0.1 778.1 668.8 339.3 448.9 10.8
557.7 228.3 998.0 888.8 119.6 0.3 0.6 557.6 339.3 888.0 998.5 778.9 10.2 117.6 228.9 668.4 449.2 0.2
"""


def test_a_straight_line_meets_published_values():
    # Certified values and standard deviations of the same page.
    x = np.array(NORRIS_X.split(), float)
    y = np.array(NORRIS_Y.split(), float)
    deviation = 0.884796396144373
    design = np.column_stack([np.ones_like(x), x])
    fit = solve(design, y, np.full(36, deviation), np.zeros(2), np.full(2, VAGUE), parameters=2)
    np.testing.assert_allclose(fit.values, [-0.262323073774029, 1.00211681802045], rtol=1e-9)
    np.testing.assert_allclose(fit.sigma, [0.232818234301152, 0.429796848199937e-3], rtol=1e-8)
    assert fit.degrees == 34
    assert fit.chi_squared == pytest.approx(34)


def test_a_known_error_is_an_observation_of_zero():
    """An offset with a known sigma counts like a covariance of the observations."""
    rng = np.random.default_rng(5)
    design = np.column_stack([np.ones(6), np.repeat([1.0, 0, 1], 2)])
    observed = rng.standard_normal(6)
    shared = np.kron(np.eye(3), np.ones((2, 1)))
    with_unknowns = solve(
        np.hstack([design, shared]), observed, np.ones(6),
        np.zeros(5), np.array([VAGUE, VAGUE, 0.7, 0.7, 0.7]), parameters=2,
    )  # fmt: skip
    covariance = np.eye(6) + 0.49 * shared @ shared.T
    information = design.T @ np.linalg.solve(covariance, design)
    direct = np.linalg.solve(information, design.T @ np.linalg.solve(covariance, observed))
    np.testing.assert_allclose(with_unknowns.values[:2], direct, rtol=1e-8)
    np.testing.assert_allclose(
        with_unknowns.covariance[:2, :2], np.linalg.inv(information), rtol=1e-8
    )
    assert with_unknowns.degrees == 4


def test_a_parameter_that_no_row_shows_is_not_determined():
    design = np.column_stack([np.ones(5), np.zeros(5)])
    fit = solve(design, np.ones(5), np.full(5, 0.1), np.zeros(2), np.ones(2), parameters=2)
    assert fit.determined.tolist() == [True, False]
    assert fit.degrees == 4


def scattered(size: float, seed: int, *, tested: bool = True):
    """Twelve groups of means with an offset each, and the fit of their common value."""
    rng = np.random.default_rng(seed)
    observed = 3 + size * rng.standard_normal(12) + 0.01 * rng.standard_normal(12)

    def fit(scatter: float):
        sigma = np.full(12, np.hypot(0.01, scatter))
        return solve(
            np.ones((12, 1)), observed, sigma, np.zeros(1), np.full(1, VAGUE), parameters=1
        )

    return with_scatter(fit, (1e-5, 10.0), np.inf, tested=tested)


def test_scatter_is_found_where_there_is_some_and_only_there():
    found = [scattered(0.2, seed) for seed in range(40)]
    sizes = np.array([one.scatter for one in found])
    assert np.sqrt(np.mean(sizes**2)) == pytest.approx(0.2, rel=0.12)
    pulls = np.array([(one.estimate.values[0] - 3) / one.estimate.sigma[0] for one in found])
    assert 0.7 < pulls.std() < 1.35
    silent = [scattered(0.0, seed) for seed in range(100)]
    assert sum(one.scatter > 0 for one in silent) <= 4  # 1 % is the bar


@pytest.mark.parametrize("size", [0.0, 0.006, 0.01, 0.03])
def test_a_scatter_that_is_not_significant_is_in_the_sigma(size):
    """As large as the noise it is in no test of twelve: pulls were 1.3 without it."""
    found = [scattered(size, seed, tested=False) for seed in range(500)]
    pulls = [(one.estimate.values[0] - 3) / one.estimate.sigma[0] for one in found]
    assert np.sqrt(np.mean(np.square(pulls))) == pytest.approx(1, abs=0.12)
    sigma = np.mean([one.estimate.sigma[0] for one in found])
    assert sigma == pytest.approx(np.hypot(0.01, size) / np.sqrt(12), rel=0.08)


def test_columns_without_information_are_in_no_combination():
    """A root of 10⁻³⁰⁸ was their size, which made biases of 10¹⁴⁴ µg of the rounding."""
    random = np.random.default_rng(3)
    rows = random.standard_normal((60, 24)) @ np.diag(np.logspace(-3, 3, 24))
    information = np.zeros((40, 40))
    seen = np.sort(random.choice(40, 24, replace=False))
    information[np.ix_(seen, seen)] = rows.T @ rows
    unseen = np.setdiff1d(np.arange(40), seen)
    combinations = whitening(information)
    assert combinations.shape == (40, 24) and not combinations[unseen].any()
    np.testing.assert_allclose(combinations.T @ information @ combinations, np.eye(24), atol=1e-6)
    effects = EffectInformation(
        tuple(map(str, range(40))), information, information @ np.ones(40), 0.0, 9
    )
    values, covariance = effects.estimate(range(40))
    np.testing.assert_allclose(values[seen], 1, rtol=1e-6)
    assert np.isnan(values[unseen]).all() and np.isnan(covariance[unseen]).all()
