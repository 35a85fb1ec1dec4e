"""Structure in residuals: silent where the model is right, and heard whatever its cause."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from inertial.arrays import Array
from inertial.model_selection.structure_tests import Structure, structures
from tests.inference.naming_evidence import Residuals, fits, whitened
from tests.inference.naming_plans import rows_of

ROWS = rows_of("c")
TIME = (ROWS.time - ROWS.time[0]) / np.ptp(ROWS.time)
N = len(TIME)
LEVEL = 0.01


def heard_of(fits: Sequence[Residuals]) -> list[Structure]:
    return structures([answer for fit in fits for answer in fit.answers()], LEVEL)


def heard(signal: Array, seed: int) -> dict[str, Structure]:
    """The tests of residuals with a signal, (2, n, 3), whose ratio to the noise is 12."""
    found = heard_of(fits("c", signal * 12 / ratio(signal), np.random.default_rng(seed)))
    return {one.kind: one for one in found}


def ratio(signal: Array) -> float:
    """Signal-to-noise ratio of what the 24 parameters and the tilts leave of a signal."""
    square = 0.0
    for (sigma, columns), part in zip(whitened("c")[1], signal, strict=True):
        known = columns.shape[1] - 12
        stacked = np.vstack([columns, np.diag(np.r_[np.zeros(12), np.ones(known)])])
        size = np.sqrt(np.sum(stacked**2, axis=0))
        y = np.r_[part.ravel() / sigma, np.zeros(len(size))]
        fit = np.linalg.lstsq(stacked / size, y, rcond=1e-12)[0]
        square += float(np.sum((y - stacked / size @ fit) ** 2))
    return float(np.sqrt(square))


def on(course: Array, sensor: int = 0, axis: int = 1) -> Array:
    """A course of one sensor axis."""
    signal = np.zeros((2, N, 3))
    signal[sensor, :, axis] = course
    return signal


def test_residuals_of_the_right_model_are_silent():
    """Six tests at 1 % together; their p-values are as uniform as many questions leave them."""
    rng = np.random.default_rng(1)
    found = [heard_of(fits("c", np.zeros((2, N, 3)), rng)) for _ in range(5)]
    assert sum(any(one.detected for one in each) for each in found) <= 1
    chances = np.array([[one.p_value for one in each] for each in found])
    assert np.mean(chances < 0.05) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / chances.size)


def telegraph(seed: int) -> Array:
    switches = np.sort(np.random.default_rng(seed).uniform(0, 1, 6))
    return np.searchsorted(switches, TIME) % 2.0


def walk(seed: int) -> Array:
    steps = np.sqrt(np.diff(ROWS.time, prepend=ROWS.time[0]))
    return np.cumsum(steps * np.random.default_rng(seed).standard_normal(N))


RIPPLE = ROWS.rate * np.cos(7.3 * np.nan_to_num(ROWS.angle) + 1)[:, None]


@pytest.mark.parametrize(
    ("signal", "kinds"),
    [
        pytest.param(on(TIME > 0.37), {"time", "change"}, id="jump"),
        pytest.param(on(telegraph(1), sensor=1), {"time", "change"}, id="telegraph"),
        pytest.param(on(walk(2)), {"time", "change"}, id="random walk"),
        pytest.param(on(TIME**3 - 1.2 * TIME, sensor=1), {"time"}, id="drift of third degree"),
        pytest.param(on(np.sin(80 * TIME)), {"time"}, id="oscillation"),
        pytest.param(np.stack([RIPPLE, 0 * RIPPLE]), {"angle"}, id="ripple of no whole order"),
        pytest.param(on(np.abs(ROWS.rate[:, 1]) ** 1.5), {"rate"}, id="rate"),
        pytest.param(on(ROWS.up[:, 0] ** 2), {"attitude"}, id="attitude"),
        pytest.param(on(ROWS.temperature**2), {"temperature"}, id="temperature"),
    ],
)
def test_a_structure_is_heard_whatever_its_cause(signal: Array, kinds: set[str]):
    found = heard(signal, 3)
    assert any(found[kind].detected for kind in kinds), found


def test_where_it_is():
    found = heard(on(TIME > 0.37), 5)
    change = found["change"]
    assert (change.sensor, change.axis) == ("gyro", "y")
    assert (change.scan_value - ROWS.time[0]) / np.ptp(ROWS.time) == pytest.approx(0.37, abs=0.05)
    assert heard(np.stack([RIPPLE, 0 * RIPPLE]), 6)["angle"].scan_value == pytest.approx(
        7.3, abs=0.3
    )


def test_what_was_fitted_is_no_structure():
    """A jump that is in the model leaves residuals without one, though they are not independent."""
    signal = on(TIME > 0.37)
    gyro, accel = fits("c", signal * 30 / ratio(signal), np.random.default_rng(7))
    step = (signal[0].ravel() / gyro.sigma)[:, None]
    space = np.hstack([gyro.design, step])
    size = np.sqrt(np.sum(space**2, axis=0))
    left = gyro.values - space / size @ np.linalg.lstsq(space / size, gyro.values)[0]
    refit = replace(gyro, values=left, design=space, prior_sigma=np.r_[gyro.prior_sigma, np.inf])
    assert {one.kind for one in heard_of([gyro, accel]) if one.detected} >= {"time", "change"}
    assert not any(one.detected for one in heard_of([refit, accel]))


def test_what_is_not_known_is_not_tested():
    gyro, accel = fits("c", np.zeros((2, N, 3)), np.random.default_rng(8))
    blind = [
        replace(one, read=replace(one.read, temperature=np.full(len(one.values), np.nan)))
        for one in (gyro, accel)
    ]
    found = {one.kind: one for one in heard_of(blind)}
    assert not found["temperature"].possible
    assert found["time"].possible


def test_noise_known_from_few_readings_is_heard_less():
    """Residuals of twice the variance: a structure where sigma is certain, none where it is not."""
    one = fits("c", np.zeros((2, N, 3)), np.random.default_rng(9))[0]
    loud = replace(one, values=np.sqrt(2) * one.values)
    certain = min(test.p_value for test in heard_of([loud]))
    unsure = min(test.p_value for test in heard_of([replace(loud, noise_degrees=20.0)]))
    assert certain < 0.01 < unsure
