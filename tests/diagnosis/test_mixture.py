"""The mixture of a class: the law of total covariance, and when it is one."""

import numpy as np
import pytest

from inertial.estimation.mixture import beside_effects, disagree, mixture


def spread(seed: int, size: int) -> np.ndarray:
    root = np.random.default_rng(seed).normal(size=(size, size + 2))
    return root @ root.T


VALUES = np.random.default_rng(1).normal(size=(3, 4)) * 3
COVARIANCES = np.array([spread(seed, 4) for seed in range(3)])
WEIGHTS = np.array([0.5, 0.3, 0.2])


def test_it_has_mean_and_covariance_of_draws_from_its_members():
    random = np.random.default_rng(2)
    count = 400_000
    drawn = np.concatenate(
        [
            random.multivariate_normal(value, covariance, round(weight * count))
            for value, covariance, weight in zip(VALUES, COVARIANCES, WEIGHTS, strict=True)
        ]
    )
    mean, covariance = mixture(VALUES, COVARIANCES, WEIGHTS * 7)
    size = np.sqrt(np.diag(covariance))
    np.testing.assert_allclose(mean / size, drawn.mean(axis=0) / size, atol=4 / np.sqrt(count))
    np.testing.assert_allclose(
        covariance / np.outer(size, size), np.cov(drawn.T) / np.outer(size, size), atol=0.02
    )


def test_two_members_by_hand():
    """Half 1 ± 1, half 5 ± 1: 3, variance 1 + 2²."""
    mean, covariance = mixture(np.array([[1.0], [5.0]]), np.ones((2, 1, 1)), np.ones(2))
    assert (mean[0], covariance[0, 0]) == (3.0, 5.0)


def test_a_member_of_no_weight_has_no_part():
    values = np.vstack([VALUES, np.full(4, np.nan)])
    covariances = np.concatenate([COVARIANCES, np.full((1, 4, 4), np.nan)])
    mean, covariance = mixture(values, covariances, np.append(WEIGHTS, 0.0))
    expected = mixture(VALUES, COVARIANCES, WEIGHTS)
    np.testing.assert_allclose(mean, expected[0])
    np.testing.assert_allclose(covariance, expected[1])


def test_what_one_member_does_not_determine_the_mixture_does_not():
    values, covariances = VALUES.copy(), COVARIANCES.copy()
    values[1, 2] = np.nan
    covariances[1, 2] = covariances[1, :, 2] = np.nan
    mean, covariance = mixture(values, covariances, WEIGHTS)
    assert list(np.isnan(mean)) == [False, False, True, False]
    assert np.isnan(covariance[2]).all() and np.isnan(covariance[:, 2]).all()
    kept = [0, 1, 3]
    assert np.isfinite(covariance[np.ix_(kept, kept)]).all()


@pytest.mark.parametrize(("off", "told"), [(0.9, False), (1.1, True)])
def test_members_disagree_beyond_a_sigma_of_the_likeliest(off, told):
    covariances = np.array([np.diag([1.0, 4.0]), np.diag([100.0, 100.0])])
    values = np.array([[10.0, 10.0], [10.0, 10.0 + 2 * off]])
    assert disagree(values, covariances) is told
    assert disagree(np.array([[1.0, np.nan], [1.0, np.nan]]), covariances) is False
    assert disagree(np.array([[1.0, np.nan], [1.0, 1.0]]), covariances) is True


def test_with_the_effects_of_the_likeliest_it_is_still_a_covariance():
    whole = spread(9, 6)
    members = np.array([whole[:4, :4], COVARIANCES[1]])
    _, covariance = mixture(VALUES[:2], members, np.array([0.6, 0.4]))
    joined = beside_effects(covariance, whole, 0.6)
    np.testing.assert_array_equal(joined[4:, 4:], whole[4:, 4:])
    np.testing.assert_array_equal(joined[:4, :4], covariance)
    assert np.linalg.eigvalsh(joined).min() > 0
