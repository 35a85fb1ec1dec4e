"""The chance of a ratio of two sums of squares: that of F where they share nothing, and drawn."""

import numpy as np
import pytest
from scipy.stats import f as f_distribution

from inertial.estimation.probability import quadratic_ratio_sf


@pytest.mark.parametrize("chance", [0.2, 1e-2, 1e-4, 1e-8])
def test_of_sums_that_share_nothing_it_is_that_of_f(chance):
    p, q = 12, 9
    above, below = (np.diag(np.repeat(own, (p, q))) for own in ([1 / p, 0.0], [0.0, 1 / q]))
    ratio = f_distribution.isf(chance, p, q)
    assert quadratic_ratio_sf(above, below, ratio) == pytest.approx(chance, rel=0.03)


def test_of_sums_that_share_readings_it_is_what_is_drawn():
    rng = np.random.default_rng(4)
    n = 20
    differences = np.diff(np.eye(n), axis=0)
    below = differences.T @ differences
    below /= np.trace(below)
    above = (np.eye(n) - 1 / n) / (n - 1)
    drawn = rng.standard_normal((40_000, n))
    squares = [np.einsum("ij,jk,ik->i", drawn, own, drawn) for own in (above, below)]
    for ratio in (1.3, 1.8):
        share = np.mean(squares[0] / squares[1] > ratio)
        scatter = 4 * np.sqrt(share / len(drawn))
        assert quadratic_ratio_sf(above, below, ratio) == pytest.approx(share, abs=scatter)


def test_where_they_are_alike_nothing_is_asked_and_what_cannot_be_has_no_chance():
    half = np.eye(6) / 6
    assert quadratic_ratio_sf(half, half, 1.0) == 1.0
    assert quadratic_ratio_sf(half, half, 1.5) == 0.0
