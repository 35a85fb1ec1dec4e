"""White noise behind slow filters, in rests of a minute and of some seconds."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import butter, lfilter

from inertial.estimation.low_pass import AVERAGE, LowPass
from inertial.estimation.multiresolution import Powers
from inertial.estimation.noise_terms import NoiseTerms, noise_terms

INTERVAL = 0.01
RESTS = (60.0,) * 6 + (6.0,) * 24  # s
BEFORE = 3000  # samples, in which a filter settles
Samples = NDArray[np.float64]


def terms(
    filtered: Callable[[Samples], Samples],
    seed: int,
    moved: float = 0.0,
    count: float | None = None,
) -> NoiseTerms:
    """The terms of white noise of 1 through a filter.

    `moved`: of what moves the first rest; `count`: size of a count, of readings that are counted.
    """
    chance, powers = np.random.default_rng(seed), Powers(1, INTERVAL)
    for number, seconds in enumerate(RESTS):
        white = chance.normal(size=round(seconds / INTERVAL) + BEFORE) / np.sqrt(INTERVAL)
        read = filtered(white)[BEFORE:]
        if not number and moved:
            slow = lfilter(*butter(2, 0.3, fs=1 / INTERVAL), chance.normal(size=len(read)))
            read = read + moved * np.cumsum(slow) * INTERVAL
        powers.add(read[:, None])
        powers.end()
    (result,) = noise_terms(powers, None if count is None else np.array([count]))
    assert result is not None
    return result


def butterworth(order: int, corner: float) -> Callable[[Samples], Samples]:
    return lambda white: np.asarray(lfilter(*butter(order, corner, fs=1 / INTERVAL), white))


def average(samples: int) -> Callable[[Samples], Samples]:
    return lambda white: np.asarray(lfilter(np.ones(samples) / samples, [1], white))


def first_order(constant: float) -> Callable[[Samples], Samples]:
    decay = np.exp(-INTERVAL / constant)
    return lambda white: np.asarray(lfilter([1 - decay], [1, -decay], white))


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("filtered", "corner", "delay"),
    [
        (butterworth(2, 1.0), 1.0, np.sqrt(2) / (2 * np.pi)),  # 2 ζ/ω
        (average(50), 0.443 / 0.5, 0.25),  # half of it
        (first_order(0.1), 1 / (2 * np.pi * 0.1), 0.1),
    ],
)
def test_a_slow_filter_is_seen_and_leaves_no_drift(filtered, corner, delay, seed):
    result = terms(filtered, seed)
    assert result.low_pass is not None
    assert result.low_pass.corner == pytest.approx(corner, rel=0.2)
    assert result.low_pass.delay == pytest.approx(delay, rel=0.3)
    white = result.terms["white_noise"]
    assert abs(white.value - 1) < max(4 * np.sqrt(result.covariance[1, 1]), 0.1)
    assert not any(result.terms[name].p_value < 1e-3 for name in ("bias_instability", "ramp"))


@pytest.mark.parametrize("moved", [0.3e3, 3e3, 3e4])
def test_what_moves_in_one_rest_is_no_filter(moved):
    assert terms(lambda white: white, 3, moved).low_pass is None


@pytest.mark.parametrize(("hertz", "size"), [(0.2, 92.0), (0.05, 640.0), (0.12, 180.0)])
def test_an_oscillation_in_all_rests_is_no_filter(hertz, size):
    """White noise of the sensor stays above it, 10 in each reading; a filter lets none pass."""

    def shaken(white: Samples) -> Samples:
        return white + size * np.sin(2 * np.pi * hertz * INTERVAL * np.arange(len(white)) + hertz)

    assert terms(shaken, 6).low_pass is None


def test_rounding_after_a_filter_is_above_it():
    """Counts of 1.7 have a density of 1.7²/12 · 0.01 = 0.0024, more than filters leave."""
    passed, count = butterworth(2, 3.0), 1.7

    def rounded(white: Samples) -> Samples:
        return count * np.round(passed(white) / count)

    found = terms(rounded, 7, count=count).low_pass
    assert found is not None and found.corner == pytest.approx(3.0, rel=0.2)
    assert terms(rounded, 7).low_pass is None  # where no count is known it may be the sensor's own


def test_white_noise_and_a_random_walk_are_behind_none():
    assert terms(lambda white: white, 4).low_pass is None
    walk = terms(lambda white: np.cumsum(white) * INTERVAL, 5)
    assert walk.low_pass is None
    assert walk.terms["random_walk"].value == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize("order", [1, 2, 4, AVERAGE])
def test_the_corner_is_where_half_of_the_power_is_left(order):
    assert LowPass(3.0, order).power(np.array([3.0])) == pytest.approx(0.5, abs=1e-3)
