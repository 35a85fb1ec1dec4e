"""Sizes of effects that were named because they are large."""

import numpy as np
import pytest
from scipy.stats import chi2, ncx2, truncnorm

from inertial.estimation.probability import ncx2_pdf
from inertial.model_selection.size_after_selection import corrected, selected

CHANCE = 2e-4  # of noise beyond the threshold, as of one of thirty effects
DEGREES = (1, 2, 3, 9)


def threshold(degrees: int) -> float:
    return float(chi2.isf(CHANCE, degrees))


def named(degrees: int, snr: float, draws: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Truth and those of some unit-variance estimates of it that exceed the threshold."""
    rng = np.random.default_rng([seed, degrees, int(snr)])
    direction = rng.normal(size=degrees)
    truth = snr * direction / np.linalg.norm(direction)
    found = truth + rng.normal(size=(draws, degrees))
    return truth, found[np.sum(found**2, axis=1) > threshold(degrees)]


def test_the_density_is_that_of_scipy():
    x, degrees = np.array([13.8, 20.0, 45.0]), np.array([1, 3, 9])
    np.testing.assert_allclose(ncx2_pdf(x, degrees, 25.0), ncx2.pdf(x, degrees, 25.0), rtol=1e-10)


@pytest.mark.parametrize("z", [3.8, 4.5, 6.0])
def test_of_one_parameter_the_mean_excess_of_a_truncated_normal_is_subtracted_twice(z):
    """Of z ~ N(m, 1) given z > a; that it is below −a has a chance of less than 10⁻¹²."""
    a = 3.72

    def centre(z: float) -> float:
        return float(np.sqrt(z**2 - 1))

    def once(z: float) -> float:
        return z - float(truncnorm(a - centre(z), np.inf).mean())

    def twice(z: float) -> float:
        law = truncnorm(a - centre(z), np.inf, loc=centre(z))
        left = law.expect(once, lb=a, ub=a + 12) - centre(z)
        return once(z) - float(left)

    how, step = selected(z**2, 1, a**2), 1e-3
    assert how.factor * z == pytest.approx(twice(z), rel=1e-5)
    slope = (twice(z + step) - twice(z - step)) / (2 * step)
    variance = float(truncnorm(a - centre(z), np.inf).var())
    assert how.along == pytest.approx(slope**2 * variance, rel=1e-3)


@pytest.mark.parametrize("degrees", [2, 3, 9])
def test_of_several_parameters_it_is_the_mean_of_draws(degrees):
    """The excess of draws, and what is left of it once the mean excess of each is subtracted."""
    c = threshold(degrees)
    statistic = c + 3
    snr = float(np.sqrt(statistic - degrees))  # as it is estimated from the statistic
    truth, found = named(degrees, snr, 400_000, seed=1)
    squares, along = np.sum(found**2, axis=1), found @ truth / snr
    centres = squares - degrees
    more = 2 * ncx2.pdf(c, degrees + 2, centres) / ncx2.sf(c, degrees, centres)
    left = along * (1 - more * np.sqrt(centres / squares)) - snr
    excess = float(np.mean(along)) - snr + float(np.mean(left))
    how = selected(statistic, degrees, c)
    assert (1 - how.factor) * np.sqrt(statistic) == pytest.approx(excess, abs=0.02)


@pytest.mark.parametrize("degrees", DEGREES)
def test_far_above_the_threshold_it_is_least_squares(degrees):
    how = selected(threshold(degrees) + 150, degrees, threshold(degrees))
    assert (how.factor, how.along, how.across) == pytest.approx((1, 1, 1), abs=1e-4)
    # Without a threshold nothing was selected.
    assert selected(30.0, degrees, 0.0).factor == 1.0 == selected(30.0, degrees, 0.0).along


@pytest.mark.parametrize("degrees", DEGREES)
def test_the_correction_grows_steadily_towards_the_threshold(degrees):
    """Further above, the little that was subtracted too much there is given back."""
    c = threshold(degrees)
    factors = [selected(c + more, degrees, c).factor for more in np.linspace(0, 60, 61)]
    short = np.array([factor for factor in factors if factor < 1])
    assert (np.diff(short) > 0).all() and len(short) > 12
    assert 0.6 < factors[0] < 0.8 and max(factors) < 1.01


@pytest.mark.slow
@pytest.mark.parametrize("snr", [5.0, 6.0, 8.0])
@pytest.mark.parametrize("degrees", DEGREES)
def test_what_is_named_is_as_large_as_it_is_said_to_be(degrees, snr):
    """Along the true direction, and within the intervals of one parameter."""
    truth, found = named(degrees, snr, 4_000, seed=2)
    c = threshold(degrees)
    sizes, inside = [], 0
    for z in found:
        how = {tuple(range(degrees)): selected(float(z @ z), degrees, c)}
        value, covariance = corrected(z, np.eye(degrees), how)
        sizes.append(value @ truth / snr**2)
        inside += abs(value[0] - truth[0]) < 1.96 * np.sqrt(covariance[0, 0])
    plain = np.mean(found @ truth) / snr**2
    # Where only half of the draws is named no estimate is without bias; it is two fifths at most.
    assert np.mean(sizes) == pytest.approx(1, abs=0.02 if len(found) > 2_800 else 0.05)
    assert abs(np.mean(sizes) - 1) < 0.4 * (plain - 1) + 0.012
    # The least is that of a single parameter at SNR 6, where the correction ends.
    assert (0.91 if degrees == 1 else 0.93) < inside / len(found) < 0.97


@pytest.mark.slow
def test_what_is_correlated_moves_along():
    """A scale factor that the fit takes for a part of the effect: both come back, with sigma."""
    covariance = np.array([[1.0, 0.5, 1.2], [0.5, 2.0, 0.8], [1.2, 0.8, 4.0]])
    c, rng = threshold(2), np.random.default_rng(3)
    truth = np.array([4.5, -1.0, 3.0])  # two parameters of the effect, and a scale factor
    block = np.linalg.inv(covariance[:2, :2])
    found = rng.multivariate_normal(truth, covariance, 6_000)
    drops = np.einsum("ni,ij,nj->n", found[:, :2], block, found[:, :2])
    errors = []
    for z, drop in zip(found[drops > c], drops[drops > c], strict=True):
        values, spread = corrected(z, covariance, {(0, 1): selected(drop, 2, c)})
        errors.append((values - truth) / np.sqrt(np.diag(spread)))
        assert np.linalg.eigvalsh(spread)[0] > 0
    assert np.mean(found[drops > c, 2] - 3.0) > 0.1  # by least squares
    assert np.abs(np.mean(errors, axis=0)).max() < 0.1
    assert np.mean(np.abs(errors) < 1.96, axis=0) == pytest.approx(0.95, abs=0.02)


def test_what_is_not_observable_stays_unknown():
    values, covariance = np.array([5.0, np.nan, 2.0]), np.diag([1.0, np.nan, 1.0])
    after, spread = corrected(values, covariance, {(0, 1): selected(25.0, 1, 16.0)})
    assert np.isnan(after[1]) and np.isnan(spread[1, 1])
    assert after[0] == pytest.approx(5 * selected(25.0, 1, 16.0).factor) and after[2] == 2.0
