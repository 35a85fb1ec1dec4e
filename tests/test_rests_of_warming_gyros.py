"""A gyro whose bias warms up reads another rate in each rest, and its turns begin where they do."""

import numpy as np
import pytest

from inertial.signal.rests_and_motions import BinStretch, rest_level
from stages.segment import windows
from stages.segment.located import divide, locate

STEP = 0.1  # s, of a bin
REST_S, TURN_S = 60.0, 8.0
NOISE = np.radians(0.006)  # rad/s, of a bin


def rates_of(bias: np.ndarray) -> np.ndarray:
    """Six rests and five turns at 60 °/s with ramps of 1 s; `bias`: °/s of each axis at first."""
    time = STEP * (np.arange(round((6 * REST_S + 5 * TURN_S) / STEP)) + 0.5)
    within = time % (REST_S + TURN_S) - REST_S
    rate = 60 * np.clip(np.minimum(within, TURN_S - within), 0, 1)
    noise = NOISE * np.random.default_rng(4).standard_normal((len(time), 3))
    turning = np.outer(rate, [1, 0, 0]) + np.outer(np.exp(-time / 250), bias)
    return np.asarray(np.radians(turning) + noise)


def turns_of(rates: np.ndarray, swings: bool) -> list[BinStretch]:
    k = len(rates)
    time = STEP * np.arange(k)
    window, forces = windows.Window("log", 0, k, []), np.tile([0, 0, 9.8], (k, 1))
    binned = windows.Binned(
        window, np.arange(k + 1), rates, forces, np.full(k, STEP), time, time + 0.08
    )
    level, scatter = rest_level(rates)
    divided = divide(binned, level, np.radians(3), 6 * scatter, swings=swings)
    return [s for s in locate(divided, manoeuvres=[]).stretches if s.moves]


@pytest.mark.parametrize("swings", [True, False])
def test_a_rest_with_another_bias_is_no_slow_end_of_the_turns_beside_it(swings):
    found = turns_of(rates_of(np.array([0.1, -0.08, 0.06])), swings)
    begin = (REST_S + TURN_S) * np.arange(5) + REST_S
    assert len(found) == 5
    np.testing.assert_allclose([STEP * s.first for s in found], begin, atol=0.15)
    np.testing.assert_allclose([STEP * s.after for s in found], begin + TURN_S, atol=0.15)
