"""S0, table 5-1: the cross terms of the accelerometers are a mounting rotation (T5 to T7)."""

import numpy as np
import pytest
import s0

from inertial.estimation.triad import mounting_and_symmetric
from inertial.physics.site import normal_gravity

N = s0.ACCELEROMETER - np.eye(3)
PAIRS = ([0, 0, 1], [1, 2, 2])  # xy, xz, yz


def test_t5_the_mounting_rotation():
    found = mounting_and_symmetric(s0.ACCELEROMETER)[:3]
    assert np.degrees(np.linalg.norm(found)) == pytest.approx(0.458673, abs=1e-6)
    # The design study has half the antisymmetric part: it differs by third order and S·θ, 2 µrad.
    np.testing.assert_allclose(found, [-0.742750e-3, -7.583250e-3, 2.463650e-3], atol=3e-6)


def test_t6_the_symmetric_rest():
    # Those of the design study, −280.55, 24.75 and −41.15 µrad, are of first order. The second
    # order has the size θ²/2 = 29 µrad; with it the rest of M = P R is:
    rest = mounting_and_symmetric(s0.ACCELEROMETER)[6:]
    np.testing.assert_allclose(rest, [-283.53e-6, 25.16e-6, -30.74e-6], atol=1e-8)


def test_the_rest_is_what_the_axes_lack_to_right_angles():
    P = np.eye(3)
    P[np.diag_indices(3)] += mounting_and_symmetric(s0.ACCELEROMETER)[3:6]
    P[PAIRS] = mounting_and_symmetric(s0.ACCELEROMETER)[6:]
    P = np.triu(P) + np.triu(P, 1).T
    # M Mᵀ = P²: the rest alone has the angles between the axes; the mounting does not enter.
    np.testing.assert_allclose(P @ P, s0.ACCELEROMETER @ s0.ACCELEROMETER.T, atol=1e-12)


def test_t7_the_scale_factors_without_the_rotation():
    # the design study has M = R P, whose P is that of Mᵀ = P Rᵀ.
    transposed = mounting_and_symmetric(s0.ACCELEROMETER.T)
    np.testing.assert_allclose(transposed[3:6], [360.80e-6, 330.85e-6, 264.91e-6], atol=1e-8)
    # With M = P R, as campaigns.md has it, they are close to the lengths of the rows.
    own = mounting_and_symmetric(s0.ACCELEROMETER)
    np.testing.assert_allclose(own[3:6], [359.79e-6, 332.29e-6, 264.47e-6], atol=1e-8)
    rows = np.linalg.norm(s0.ACCELEROMETER, axis=1) - 1
    np.testing.assert_allclose(own[3:6], rows, atol=1e-7)
    assert np.mean(transposed[3:6]) == pytest.approx(318.8e-6, abs=1e-7)
    # The rotation is the same in both forms; the transposed one turns the other way.
    np.testing.assert_allclose(own[:3], -transposed[:3], atol=1e-12)
    # The diagonal of S alone hides cos θ: 32, 3 and 29 ppm.
    np.testing.assert_allclose(
        np.diag(N) - transposed[3:6], [-32.3e-6, -2.6e-6, -29.2e-6], atol=1e-7
    )


def test_gravity_is_not_what_the_scale_factors_have_in_common():
    # 319 ppm would be a gravity wrong by 312 mGal; it is normal gravity at a height of 15 m.
    assert normal_gravity(s0.LATITUDE, 15) == pytest.approx(s0.GRAVITY, abs=2e-6)
