"""A channel by itself: generalised least squares of its means, with shared errors and a walk."""

import numpy as np
import pytest

from stages.extension.channels import Mean, system_of

NAMES = ["effect.k"]
TILT = 3e-4


def means(seed: int, size: float, walk: float = 0.0) -> list[Mean]:
    """Twelve rests of 10 s a minute apart, along x or against it; each tilt is that of two."""
    random = np.random.default_rng(seed)
    drift = np.cumsum(walk * np.sqrt(60.0) * random.normal(size=12))
    tilts = TILT * random.normal(size=6)
    found = []
    for i in range(12):
        along = np.array([(-1.0) ** i, 0.0, 0.0])
        trace = np.full((3, 1), float(i % 3 == 0))
        noise = 1e-3 * random.normal(size=3)
        residual = size * trace[:, 0] + tilts[i // 2] + drift[i] + noise
        errors = {("tilt", str(i // 2)): (np.ones(3), TILT)}
        found.append(Mean(f"rest {i}", residual, np.full(3, 1e-3), along, trace, errors, 60.0 * i))
    return found


@pytest.mark.parametrize("walk", [0.0, 2e-4])
def test_it_is_generalised_least_squares(walk):
    some = means(1, 5e-3, walk)
    system = system_of(some, NAMES, 1, NAMES, walk)
    assert system is not None
    told = system.effect_information()
    time = np.array([mean.time for mean in some])
    pairs = np.arange(12) // 2
    covariance = 1e-6 * np.eye(12) + TILT**2 * (pairs[:, None] == pairs)
    covariance += walk**2 * np.minimum.outer(time, time)
    columns = np.array([[mean.truth[0], 1.0, mean.traces[1, 0]] for mean in some])
    weight = np.linalg.inv(covariance)
    spread = np.linalg.inv(columns.T @ weight @ columns)
    best = spread @ columns.T @ weight @ np.array([mean.residual[1] for mean in some])
    value, variance = told.estimate([0])
    # M and the bias are known beforehand to 0.1 and 1, which is a millionth of this.
    assert value[0] == pytest.approx(best[2], rel=1e-3)
    assert variance[0, 0] == pytest.approx(spread[2, 2], rel=1e-3)


def test_chi_squared_is_that_of_the_noise_where_the_model_is_whole():
    each = []
    for seed in range(60):
        system = system_of(means(seed, 0.0, 2e-4), NAMES, 0, [], 2e-4)
        assert system is not None
        each.append(system.solve().chi_squared)
    # Twelve means less a bias and an element of M; its own scatter is √(20 / 60).
    assert abs(np.mean(each) - 10) < 4 * np.sqrt(20 / 60)


def test_a_channel_without_readings_has_no_equations():
    some = [Mean(*[*vars(mean).values()]) for mean in means(1, 0.0)]
    for mean in some:
        mean.residual[2] = np.nan
    assert system_of(some, NAMES, 2, NAMES, 0.0) is None
