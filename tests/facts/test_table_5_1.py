"""S0, table 5-1: the cross terms of the accelerometers are a mounting rotation (T5 to T7)."""

import numpy as np
import pytest
import s0

from inertial.estimation.triad import mounting_and_symmetric
from inertial.physics.site import normal_gravity

N = s0.ACCELEROMETER - np.eye(3)
PAIRS = ([0, 0, 1], [1, 2, 2])  # xy, xz, yz
ARC_SECOND = np.radians(1 / 3600)


def test_t5_the_mounting_rotation():
    found = mounting_and_symmetric(s0.ACCELEROMETER)[:3]
    assert np.degrees(np.linalg.norm(found)) == pytest.approx(0.458673, abs=1e-6)
    first_order = (N - N.T)[[1, 2, 0], [2, 0, 1]] / 2
    np.testing.assert_allclose(first_order, [-0.742750e-3, -7.583250e-3, 2.463650e-3], atol=1e-9)
    assert np.degrees(np.linalg.norm(first_order)) == pytest.approx(0.458821, abs=1e-6)
    # The rotation is half the antisymmetric part but for third order and S·θ, 2 µrad.
    np.testing.assert_allclose(found, first_order, atol=3e-6)


def test_t6_the_symmetric_rest():
    first_order = ((N + N.T) / 2)[PAIRS]
    np.testing.assert_allclose(first_order, [-280.55e-6, 24.75e-6, -41.15e-6], atol=1e-9)
    np.testing.assert_allclose(first_order / ARC_SECOND, [-57.87, 5.11, -8.49], atol=0.005)
    # Those of the design study are of first order. The second order has the size θ²/2 = 29 µrad;
    # with it the rest of M = P R is:
    rest = mounting_and_symmetric(s0.ACCELEROMETER)[6:]
    np.testing.assert_allclose(rest, [-283.53e-6, 25.16e-6, -30.74e-6], atol=1e-8)
    noise = s0.per_root_second(s0.VELOCITY_RANDOM_WALK) / np.sqrt(2 * 300) / s0.GRAVITY
    assert noise == pytest.approx(2.08e-6, abs=0.01e-6)  # of a cross term, two rests of 300 s
    assert abs(first_order[0]) / noise == pytest.approx(135, abs=1)


def test_the_rest_is_what_the_axes_lack_to_right_angles():
    rows = s0.ACCELEROMETER / np.linalg.norm(s0.ACCELEROMETER, axis=1, keepdims=True)
    seconds = np.degrees(np.arccos((rows @ rows.T)[PAIRS]) - np.pi / 2) * 3600
    np.testing.assert_allclose(seconds, [116.92, -10.38, 12.68], atol=0.01)
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
    np.testing.assert_allclose(rows, [359.833e-6, 332.331e-6, 264.474e-6], atol=1e-9)
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
    milligal = 318.8e-6 * s0.GRAVITY / 1e-5
    assert milligal == pytest.approx(312, abs=1)
