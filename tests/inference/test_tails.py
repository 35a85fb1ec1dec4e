"""The tails and bounds of the distributions are those of scipy.stats, however small the chance."""

import numpy as np
import pytest
from scipy import stats

from inertial.estimation.probability import (
    chi_squared_beyond,
    chi_squared_bound,
    noncentral_beyond,
    normal_beyond,
    ratio_beyond,
    ratio_bound,
    student_beyond,
)

VALUES = np.array([0.0, 1e-3, 0.5, 1.0, 3.0, 30.0, 300.0, 1200.0])
CHANCES = np.array([1e-300, 1e-100, 1e-12, 1e-4, 0.01, 0.5, 0.99, 1.0])
DEGREES = np.array([1, 2, 3, 9, 40])[:, None]


def test_chi_squared():
    np.testing.assert_allclose(
        chi_squared_beyond(VALUES, DEGREES), stats.chi2.sf(VALUES, DEGREES), rtol=1e-10
    )
    np.testing.assert_allclose(
        chi_squared_bound(CHANCES, DEGREES), stats.chi2.isf(CHANCES, DEGREES), rtol=1e-10
    )
    assert chi_squared_beyond(-1.0, 3) == 1.0


def test_the_noncentral_one():
    snr = np.array([0.5, 5.0, 8.0])[:, None, None]
    ours = noncentral_beyond(VALUES, DEGREES, snr**2)
    np.testing.assert_allclose(ours, stats.ncx2.sf(VALUES, DEGREES, snr**2), atol=1e-12)


@pytest.mark.parametrize("of_noise", [5.0, 200.0, 1e5])
def test_ratios_of_mean_squares(of_noise):
    np.testing.assert_allclose(
        ratio_beyond(VALUES, DEGREES, of_noise),
        stats.f.sf(VALUES, DEGREES, of_noise),
        rtol=1e-8,
        atol=1e-300,
    )
    chances = CHANCES[(CHANCES > 1e-12) & (CHANCES < 1)]
    np.testing.assert_allclose(
        ratio_bound(chances, DEGREES, of_noise), stats.f.isf(chances, DEGREES, of_noise), rtol=1e-8
    )
    rare = ratio_bound(1e-60, DEGREES, of_noise)
    np.testing.assert_allclose(ratio_beyond(rare, DEGREES, of_noise), 1e-60, rtol=1e-6)


def test_student_and_normal():
    np.testing.assert_allclose(student_beyond(VALUES, 7), stats.t.sf(VALUES, 7), rtol=1e-10)
    np.testing.assert_allclose(normal_beyond(VALUES[:5]), stats.norm.sf(VALUES[:5]), rtol=1e-10)
