"""What M falls into: S0's table 5-1 taken apart."""

import numpy as np
import pytest

from inertial.estimation.triad import design_of, jacobian_of_mounting, mounting_and_symmetric

# S0, table 5-1; γ_yx, the x axis senses the y force, in row x, column y.
S0_ACCELEROMETER = np.eye(3) + np.array(
    [
        [0.00032852, 0.0021831, 0.0076080],
        [-0.0027442, 0.00032826, -0.0007839],
        [-0.0075585, 0.0007016, 0.00023567],
    ]
)


def test_the_cross_terms_of_the_report_are_a_mounting_rotation():  # T5
    mounting = mounting_and_symmetric(S0_ACCELEROMETER)[:3]
    # First order: half the antisymmetric part, -0.742750, -7.583250, 2.463650 mrad.
    first_order = np.array([-0.742750, -7.583250, 2.463650]) * 1e-3
    np.testing.assert_allclose(mounting, first_order, atol=2e-5)
    assert np.degrees(np.linalg.norm(mounting)) == pytest.approx(0.45867, abs=1e-5)


def test_what_is_not_square_is_a_third_of_a_milliradian():  # T6, by first order: xy, xz, yz
    N = S0_ACCELEROMETER - np.eye(3)
    first_order = (N + N.T)[[0, 0, 1], [1, 2, 2]] / 2
    np.testing.assert_allclose(first_order, np.array([-280.55, 24.75, -41.15]) * 1e-6, atol=1e-8)
    rest = mounting_and_symmetric(S0_ACCELEROMETER)[6:]
    # θ²/2 is 29 µrad, so to second order the rest differs by as much, and no more.
    np.testing.assert_allclose(rest, first_order, atol=3e-5)


def test_a_pure_rotation_of_the_triad_comes_back_with_its_sign():
    # The triad turned by +1° about z: its x axis points towards y, so a force along y shows on x.
    angle = np.radians(1)
    M = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    np.testing.assert_allclose(mounting_and_symmetric(M), [0, 0, angle, *np.zeros(6)], atol=1e-12)


def test_the_jacobian_predicts_a_small_change():
    change = 1e-5 * np.random.default_rng(3).standard_normal((3, 3))
    exact = mounting_and_symmetric(S0_ACCELEROMETER + change) - mounting_and_symmetric(
        S0_ACCELEROMETER
    )
    predicted = jacobian_of_mounting(S0_ACCELEROMETER) @ change.ravel()
    np.testing.assert_allclose(predicted, exact, atol=1e-9)


def test_the_design_gives_the_reading_of_the_equation():
    truth, bias = np.array([0.1, -0.2, 9.8]), np.array([1e-3, 2e-3, -3e-3])
    unknowns = np.append(S0_ACCELEROMETER.ravel(), bias)
    np.testing.assert_allclose(design_of(truth) @ unknowns, S0_ACCELEROMETER @ truth + bias)
