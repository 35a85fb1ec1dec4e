"""S0, table 5-9: after compensation the means keep the same sign up and down (T10)."""

import numpy as np
import pytest
import s0

from inertial.estimation.accelerometer_formulas import six_position_formula
from inertial.estimation.accelerometers import StaticForce


def even_and_odd(up: np.ndarray, down: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What keeps its sign in means with an axis up and down, and what changes it."""
    return (up + down) / 2, (up - down) / 2 - s0.GRAVITY


EVEN, ODD = even_and_odd(s0.COMPENSATED_UP, s0.COMPENSATED_DOWN)  # m/s²


def six(reading) -> list[StaticForce]:
    """Six rests, whose readings are a function of the force."""
    ups = [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)]
    return [StaticForce(str(up), up, reading(s0.GRAVITY * up), np.full(3, 1e-5)) for up in ups]


def test_the_same_data_would_leave_no_odd_part():
    """So the means of table 5-9 are of another stretch than table 5-1."""
    random = np.random.default_rng(9)
    rests = six(lambda force: s0.ACCELEROMETER @ force + random.normal(0, 1e-3, 3))
    unknowns, _ = six_position_formula(rests, s0.GRAVITY, 0.0, 0.0)
    M, bias = unknowns[:9].reshape(3, 3), unknowns[9:]
    means = np.array([np.linalg.solve(M, rest.mean - bias) for rest in rests])
    even, odd = even_and_odd(means[[0, 2, 4], range(3)], means[[1, 3, 5], range(3)])
    np.testing.assert_allclose(odd, 0, atol=1e-12)
    assert np.abs(even).max() > 1e-4
    assert np.abs(ODD).max() > 1e-5


def test_the_square_that_would_leave_such_an_even_part():
    """1.5 × even: 35.4, 10.4, 18.7 µg/g², hidden in six positions and found again."""
    # The bias of the formula is the mean of all six positions: of K₂ f², which two of them hold,
    # that is a third, and two thirds stay.
    square = 1.5 * EVEN / s0.GRAVITY**2  # per m/s²
    np.testing.assert_allclose(square * s0.GRAVITY**2, [347.1e-6, 102.2e-6, 183.6e-6], atol=1e-7)
    rests = six(lambda force: force + square * force**2)
    unknowns, _ = six_position_formula(rests, s0.GRAVITY, 0.0, 0.0)
    np.testing.assert_allclose(unknowns[:9].reshape(3, 3), np.eye(3), atol=1e-12)
    left = np.array([rest.mean - unknowns[9:] for rest in rests])
    even, _ = even_and_odd(left[[0, 2, 4], range(3)], left[[1, 3, 5], range(3)])
    np.testing.assert_allclose(even, EVEN, rtol=1e-9)
    assert square[0] * s0.GRAVITY**2 / s0.GRAVITY == pytest.approx(35.4e-6, abs=5e-8)
