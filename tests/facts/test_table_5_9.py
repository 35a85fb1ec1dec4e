"""S0, table 5-9: after compensation the means keep the same sign up and down (T10)."""

import numpy as np
import pytest
import s0

from inertial.estimation.accelerometers import Rest, formula
from inertial.estimation.averaging_time import per_root_second
from inertial.estimation.even_and_odd import even_and_odd, square_behind
from inertial.physics.site import STANDARD_GRAVITY

SIGMA = np.full(3, per_root_second(s0.VELOCITY_RANDOM_WALK) / np.sqrt(300))  # T is not printed
SPLIT = even_and_odd(s0.COMPENSATED_UP, s0.COMPENSATED_DOWN, s0.GRAVITY, (SIGMA, SIGMA))


def test_t10_the_even_and_the_odd_part():
    np.testing.assert_allclose(SPLIT.even, [231.4e-6, 68.1e-6, 122.4e-6], atol=1e-9)
    np.testing.assert_allclose(SPLIT.odd, [-15.1e-6, -10.6e-6, 30.0e-6], atol=1e-9)
    np.testing.assert_allclose(
        SPLIT.odd / s0.GRAVITY, [-1.5418e-6, -1.0823e-6, 3.0632e-6], atol=1e-10
    )
    np.testing.assert_allclose(SPLIT.even / SPLIT.sigma, [11.3, 3.3, 6.0], atol=0.05)
    assert SPLIT.p_value(SPLIT.even) < 1e-30 and SPLIT.p_value(SPLIT.odd) > 0.2
    # the design study has 23.63, 6.95, 12.50 µg, of S0's local g; of the standard g of data sheets:
    np.testing.assert_allclose(SPLIT.even / s0.GRAVITY, [23.63e-6, 6.95e-6, 12.50e-6], atol=6e-9)
    np.testing.assert_allclose(
        SPLIT.even / STANDARD_GRAVITY, [23.60e-6, 6.94e-6, 12.48e-6], atol=6e-9
    )


def six(reading) -> list[Rest]:
    """Six rests, whose readings are a function of the force."""
    ups = [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)]
    return [Rest(str(up), up, reading(s0.GRAVITY * up), np.full(3, 1e-5)) for up in ups]


def test_the_same_data_would_leave_no_odd_part():
    """So the means of table 5-9 are of another stretch than table 5-1."""
    random = np.random.default_rng(9)
    rests = six(lambda force: s0.ACCELEROMETER @ force + random.normal(0, 1e-3, 3))
    unknowns, _ = formula(rests, s0.GRAVITY, 0.0, 0.0)
    M, bias = unknowns[:9].reshape(3, 3), unknowns[9:]
    means = np.array([np.linalg.solve(M, rest.mean - bias) for rest in rests])
    own = even_and_odd(
        means[[0, 2, 4], range(3)], means[[1, 3, 5], range(3)], s0.GRAVITY, (SIGMA,) * 2
    )
    np.testing.assert_allclose(own.odd, 0, atol=1e-12)
    assert np.abs(own.even).max() > 1e-4


def test_the_square_that_would_leave_such_an_even_part():
    """1.5 × even: 35.4, 10.4, 18.7 µg/g², hidden in six positions and found again."""
    square = square_behind(SPLIT.even, s0.GRAVITY)  # per m/s²
    np.testing.assert_allclose(square * s0.GRAVITY**2, [347.1e-6, 102.2e-6, 183.6e-6], atol=1e-7)
    rests = six(lambda force: force + square * force**2)
    unknowns, _ = formula(rests, s0.GRAVITY, 0.0, 0.0)
    np.testing.assert_allclose(unknowns[:9].reshape(3, 3), np.eye(3), atol=1e-12)
    left = np.array([rest.mean - unknowns[9:] for rest in rests])
    found = even_and_odd(
        left[[0, 2, 4], range(3)], left[[1, 3, 5], range(3)], s0.GRAVITY, (SIGMA,) * 2
    )
    np.testing.assert_allclose(found.even, SPLIT.even, rtol=1e-9)
    assert square[0] * s0.GRAVITY**2 / s0.GRAVITY == pytest.approx(35.4e-6, abs=5e-8)
