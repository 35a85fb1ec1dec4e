"""The tails and bounds of the distributions are those of scipy.stats, however small the chance."""

import numpy as np
import pytest
from scipy import stats

from inertial.estimation.probability import (
    chi2_isf,
    chi2_sf,
    f_isf,
    f_sf,
    ncx2_sf,
    norm_sf,
    t_sf,
)

VALUES = np.array([0.0, 1e-3, 0.5, 1.0, 3.0, 30.0, 300.0, 1200.0])
CHANCES = np.array([1e-300, 1e-100, 1e-12, 1e-4, 0.01, 0.5, 0.99, 1.0])
DEGREES = np.array([1, 2, 3, 9, 40])[:, None]


def test_chi_squared():
    np.testing.assert_allclose(chi2_sf(VALUES, DEGREES), stats.chi2.sf(VALUES, DEGREES), rtol=1e-10)
    np.testing.assert_allclose(
        chi2_isf(CHANCES, DEGREES), stats.chi2.isf(CHANCES, DEGREES), rtol=1e-10
    )
    assert chi2_sf(-1.0, 3) == 1.0


def test_the_noncentral_one():
    snr = np.array([0.5, 5.0, 8.0])[:, None, None]
    ours = ncx2_sf(VALUES, DEGREES, snr**2)
    np.testing.assert_allclose(ours, stats.ncx2.sf(VALUES, DEGREES, snr**2), atol=1e-12)


@pytest.mark.parametrize("of_noise", [5.0, 200.0, 1e5])
def test_ratios_of_mean_squares(of_noise):
    np.testing.assert_allclose(
        f_sf(VALUES, DEGREES, of_noise),
        stats.f.sf(VALUES, DEGREES, of_noise),
        rtol=1e-8,
        atol=1e-300,
    )
    chances = CHANCES[(CHANCES > 1e-12) & (CHANCES < 1)]
    np.testing.assert_allclose(
        f_isf(chances, DEGREES, of_noise), stats.f.isf(chances, DEGREES, of_noise), rtol=1e-8
    )
    rare = f_isf(1e-60, DEGREES, of_noise)
    np.testing.assert_allclose(f_sf(rare, DEGREES, of_noise), 1e-60, rtol=1e-6)


def test_student_and_normal():
    np.testing.assert_allclose(t_sf(VALUES, 7), stats.t.sf(VALUES, 7), rtol=1e-10)
    np.testing.assert_allclose(norm_sf(VALUES[:5]), stats.norm.sf(VALUES[:5]), rtol=1e-10)
