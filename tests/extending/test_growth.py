"""Errors of free inertial navigation after a minute, by hand."""

import numpy as np

from stages.extension.navigation_error import grown

G = 9.8
UP = np.array([0.0, 0.0, G])


def test_a_gyro_bias_of_one_degree_per_hour():
    bias = np.radians(1 / 3600) * np.array([1.0, 0.0, 0.0])
    attitude, velocity = grown(bias, np.zeros(3), UP)
    np.testing.assert_allclose(np.degrees(attitude), [1 / 60, 0, 0])
    # g ψ t / 2 = 9.8 · 2.909e-4 · 30, level and across the axis of the error.
    np.testing.assert_allclose(velocity, [0, -G * np.radians(1 / 60) * 30, 0])
    np.testing.assert_allclose(np.linalg.norm(velocity), 0.0855, rtol=1e-3)


def test_a_gyro_bias_about_the_vertical_moves_no_velocity():
    _, velocity = grown(np.array([0, 0, 1e-5]), np.zeros(3), UP)
    np.testing.assert_allclose(velocity, 0)


def test_an_accelerometer_bias_of_a_hundred_micro_g():
    attitude, velocity = grown(np.zeros(3), np.array([1e-4 * G, 0, 0]), UP)
    np.testing.assert_allclose(attitude, 0)
    np.testing.assert_allclose(velocity, [1e-4 * G * 60, 0, 0])


def test_it_is_what_strapdown_navigation_makes_of_the_errors():
    rate, force = np.array([2e-5, -1e-5, 3e-5]), np.array([1e-3, 2e-3, -1e-3])
    _, velocity = grown(rate, force, UP)
    matrix, moved, step = np.eye(3), np.zeros(3), 0.01
    for _ in range(6000):
        x, y, z = rate * step
        matrix = matrix @ (np.eye(3) + np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]))
        moved += (matrix @ (UP + force) - UP) * step
    np.testing.assert_allclose(velocity, moved, rtol=5e-3, atol=1e-4)
