"""Positions that are off by a degree or more: what is of second order in a tilt is not small."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inertial.estimation.accelerometers import Reference, StaticForce, fit
from inertial.estimation.position_outlier import far_off
from inertial.estimation.random_walk import NO_DRIFT

GRAVITY, NOISE, ARC_SECOND = 9.8, 1e-4, np.radians(1 / 3600)
UPS = np.array([sign * axis for axis in np.eye(3) for sign in (1, -1)])


def readings(random, ups, tilts):
    """Of exact tilts, rotation vectors (n, 3), by M and a bias that are drawn; and these."""
    matrix = np.eye(3) + random.normal(0, 5e-3, (3, 3))
    bias = random.normal(0, 0.1, 3)
    forces = Rotation.from_rotvec(tilts).apply(GRAVITY * ups)
    means = forces @ matrix.T + bias + random.normal(0, NOISE, ups.shape)
    statics = [
        StaticForce(f"rest {i}", up, mean, np.full(3, NOISE))
        for i, (up, mean) in enumerate(zip(ups, means, strict=True))
    ]
    return statics, np.append(matrix.ravel(), bias)


@pytest.mark.parametrize("degrees", [0.01, 1.0])
def test_sigmas_of_positions_set_by_hand_hold(degrees):
    # Six rests tell a tilt from a cross term to 0.7 of the tilt only; the cosine of the tilt goes
    # with it, g · 0.017 · 0.012 = 2 mm/s², and that is what a bias is uncertain by.
    sigma, pulls, of_bias = np.radians(degrees), [], []
    for seed in range(60):
        random = np.random.default_rng(seed)
        statics, true = readings(random, UPS, random.normal(0, sigma, (6, 3)))
        result = fit(statics, Reference(GRAVITY, 1e-3, sigma)).estimate
        pulls.append((result.values[:12] - true) / result.sigma[:12])
        of_bias.append(result.sigma[9:12].mean())
    rms = np.sqrt(np.mean(np.square(pulls), axis=0))
    assert rms[9:].max() < 1.35
    assert rms[[1, 2, 3, 5, 6, 7]].max() < 1.35
    assert rms[9:].min() > 0.75
    if degrees == 1.0:
        assert np.mean(of_bias) == pytest.approx(2e-3, rel=0.5)


@pytest.mark.parametrize("degrees", [0.3, 0.7, 5.0])
def test_a_position_off_by_degrees_is_told_with_its_angle(degrees):
    random = np.random.default_rng(7)
    ups = np.vstack([UPS, UPS])
    tilts = random.normal(0, 5 * ARC_SECOND, (12, 3))
    tilts[3] += [0, 0, np.radians(degrees)]  # −y up, about z
    statics, _true = readings(random, ups, tilts)
    reference = Reference(GRAVITY, 1e-4, 5 * ARC_SECOND)
    (off,) = far_off(statics, reference, None, NO_DRIFT)
    assert off.position == "rest 3"
    assert off.tilt[2] == pytest.approx(np.radians(degrees), abs=20 * ARC_SECOND)
    tilts[3] = 0.0
    statics, _true = readings(random, ups, tilts)
    assert far_off(statics, reference, None, NO_DRIFT) == []


@pytest.mark.parametrize("degrees", [1 / 60, 1.0])
def test_tilts_along_an_axis_that_no_rest_has_up_determine_no_scale_factor(degrees):
    # y is level in all rests: what it reads of gravity is a tilt, by any scale factor of it.
    never = np.array([not np.any(up[1]) for up in UPS])
    ups = np.tile(UPS[never], (3, 1))
    sigma = np.radians(degrees)
    for seed in range(5):
        random = np.random.default_rng(seed)
        statics, true = readings(random, ups, random.normal(0, sigma, (len(ups), 3)))
        found = fit(statics, Reference(GRAVITY, 1e-3, sigma)).estimate
        of_y = np.zeros((3, 3), bool)
        of_y[:, 1] = True
        np.testing.assert_array_equal(found.determined[:9].reshape(3, 3), ~of_y)
        pulls = (found.values[:12] - true) / found.sigma[:12]
        assert np.abs(pulls[[0, 2, 6, 8, 9, 11]]).max() < 4
