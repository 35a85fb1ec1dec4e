"""Of two likely scatters the least is taken: the larger leaves nothing in common."""

import numpy as np
import pytest

from inertial.estimation.least_squares import Estimate
from inertial.estimation.scatter_and_random_walk import with_scatter


def fit_of(deviance):
    """Fits whose deviance is known, and whose residuals noise alone cannot explain."""

    def fit(scatter: float) -> Estimate:
        logarithm = np.log10(max(scatter, 1e-12))
        return Estimate(
            np.zeros(1), np.eye(1), np.ones(1, bool), 1e4, 100, deviance(logarithm), 101
        )

    return fit


def test_the_nearer_of_two_valleys():
    def deviance(logarithm):
        return min(1000 * (logarithm + 5) ** 2, 500 * (logarithm + 1) ** 2 - 1000)

    found = with_scatter(fit_of(deviance), (1e-11, 0.1), np.inf)
    assert found.scatter == pytest.approx(1e-5, rel=0.1)


def test_a_single_valley_at_the_end_of_what_is_possible():
    found = with_scatter(fit_of(lambda logarithm: -100 * logarithm), (1e-11, 0.1), np.inf)
    assert found.scatter == pytest.approx(0.1, rel=0.1)
