"""Accelerometers from rests of unknown attitude: closure, what is not told, a real recording."""

from functools import partial

import numpy as np
import pytest
from moved_by_hand import (
    EDGES,
    FACES,
    GRAVITY,
    GRAVITY_SIGMA,
    MPU6050,
    TWENTY_FOUR,
    Imu,
    rests,
)
from scipy.linalg import rq

from inertial.estimation.multi_position import (
    FREE,
    NAMES,
    PAIRS,
    PRIOR,
    FreeRest,
    free_positions,
    matrix_of,
    unobservable,
)
from inertial.estimation.scatter_and_random_walk import with_scatter
from inertial.estimation.triad import mounting_and_symmetric

A_TENTH = np.radians(0.1)


def solved(found, scatter=0.0):
    return free_positions(found, GRAVITY, GRAVITY_SIGMA, scatter)


@pytest.mark.slow
def test_24_positions_by_a_tenth_of_a_degree_give_30_ppm_and_honest_sigmas():
    # 24 rests of a minute with the demo's noise: 1.4 ppm of g in each mean, and 5 ppm of gravity.
    pulls, errors, misfits = [], [], []
    for seed in range(200):
        imu = Imu(np.random.default_rng(seed))
        gravity = GRAVITY + GRAVITY_SIGMA * imu.rng.standard_normal()
        estimate = free_positions(rests(imu, TWENTY_FOUR, 60, A_TENTH), gravity, GRAVITY_SIGMA)
        error = estimate.values[:FREE] - imu.free
        pulls.append(error / estimate.sigma[:FREE])
        errors.append(error / np.repeat([1.0, GRAVITY], [6, 3]))
        misfits.append(estimate.chi_squared)
        assert estimate.degrees == 15 and estimate.determined[:FREE].all()
    assert np.abs(errors).max() < 30e-6  # 14 ppm
    assert np.sqrt(np.mean(np.square(pulls), axis=0)) == pytest.approx(np.ones(FREE), abs=0.15)
    assert np.mean(np.abs(pulls) < 1.96) == pytest.approx(0.95, abs=0.015)
    assert np.mean(misfits) == pytest.approx(15, abs=4 * np.sqrt(30 / 200))


def test_gravity_scales_all_scale_factors_alike():
    imu = Imu(np.random.default_rng(1))
    found = rests(imu, TWENTY_FOUR, 60, A_TENTH)
    right, wrong = solved(found), free_positions(found, GRAVITY * 1.001, GRAVITY_SIGMA)
    np.testing.assert_allclose(matrix_of(wrong.values), matrix_of(right.values) / 1.001, rtol=1e-6)
    covariance = right.covariance[:3, :3]
    assert right.sigma[:3].min() > GRAVITY_SIGMA / GRAVITY
    assert covariance[0, 1] / np.sqrt(covariance[0, 0] * covariance[1, 1]) > 0.95


@pytest.mark.slow
def test_noise_that_makes_readings_longer_does_not_make_the_scale_factors_larger():
    # At 0.8 m/s² it would be σ²/g² = 0.7 %.
    sigma, scales = np.array([0.6, 0.8, 1.0]), []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        up = rng.standard_normal((40, 3))
        readings = GRAVITY * up / np.linalg.norm(up, axis=1)[:, None]
        readings += sigma * rng.standard_normal((40, 3))
        found = [FreeRest(str(i), readings[i], sigma) for i in range(40)]
        scales.append(solved(found).values[:3].mean() - 1)
    assert abs(np.mean(scales)) < 2 * np.std(scales) / np.sqrt(60) < 0.8 * (0.8 / GRAVITY) ** 2


@pytest.mark.slow
def test_what_rests_differ_by_beyond_noise_is_found():
    rng, sizes = np.random.default_rng(3), []
    for _ in range(10):
        found = rests(Imu(rng), np.vstack([TWENTY_FOUR, EDGES]), 60, A_TENTH)
        astray = [FreeRest(r.name, r.mean + 1e-3 * rng.standard_normal(3), r.sigma) for r in found]
        fitted = with_scatter(partial(solved, astray), (1e-7, 1.0), np.inf)
        sizes.append(fitted.scatter)
        assert fitted.p_value < 1e-10
    assert np.mean(sizes) == pytest.approx(1e-3, rel=0.15)


# ---- what is not told


def named(estimate):
    return {tuple(one.names): tuple(one.up) for one in unobservable(estimate)}


@pytest.mark.parametrize("scatter", [0.0, A_TENTH])
def test_six_faces_tell_no_angle_between_axes(scatter):
    imu = Imu(np.random.default_rng(4), noise=MPU6050)
    estimate = solved(rests(imu, FACES, 3, scatter))
    assert named(estimate) == {
        ("symmetric_xy",): (1, 1, 0),
        ("symmetric_xz",): (1, 0, 1),
        ("symmetric_yz",): (0, 1, 1),
    }
    told = dict(zip(NAMES, estimate.determined, strict=False))
    assert [name for name in NAMES if not told[name]] == list(NAMES[3:6])
    pulls = (estimate.values[:FREE] - imu.free) / estimate.sigma[:FREE]
    assert np.abs(pulls[[0, 1, 2, 6, 7, 8]]).max() < 3


def test_the_rest_that_is_proposed_tells_what_was_missing():
    imu = Imu(np.random.default_rng(5))
    ups = list(FACES)
    for _ in range(3):
        first = unobservable(solved(rests(imu, np.array(ups), 60, 0.0)))[0]
        ups.append(first.up / np.linalg.norm(first.up))
    estimate = solved(rests(imu, np.array(ups), 60, 0.0))
    assert not unobservable(estimate) and estimate.determined[:FREE].all()


def test_a_face_that_is_missing_leaves_scale_and_bias_together():
    ups = np.vstack([FACES[:5], EDGES[EDGES[:, 2] == 0]])
    lacks = named(solved(rests(Imu(np.random.default_rng(6)), ups, 60, 0.0)))
    assert lacks[("symmetric_zz", "bias_z")] == (0, 0, -1)
    assert ("symmetric_xy",) not in lacks


def test_one_rest_tells_nothing_and_a_prior_is_no_estimate():
    estimate = solved(rests(Imu(np.random.default_rng(7)), FACES[:1], 60, 0.0))
    assert not estimate.determined[:FREE].any()
    assert ("symmetric_xx", "bias_x") in named(estimate)


@pytest.mark.parametrize("seed", range(6))
def test_rests_in_one_plane_tell_no_scale_factor_across_it(seed):
    """A scale factor near 0 would fit any noise there, and seem to be known to half a percent."""
    angles = np.linspace(0.3, 12, 24)
    plane = np.column_stack([np.cos(angles), np.zeros(24), np.sin(angles)])
    imu = Imu(np.random.default_rng(seed), noise=MPU6050)
    estimate = solved(rests(imu, plane, 10, 0.0))
    assert not estimate.determined[NAMES.index("symmetric_yy")]
    assert "symmetric_yy" in [name for each in unobservable(estimate) for name in each.names]
    pulls = (estimate.values[:FREE] - imu.free) / estimate.sigma[:FREE]
    assert np.abs(pulls).max() < 3.5


@pytest.mark.parametrize("tilt", [0.0, 1.0, 3.0])
def test_two_positions_with_an_unknown_tilt(tilt):
    # S1: one axis up, then down, its tilt not known. Two readings tell its bias and scale factor as
    # well as the level axes tell the tilt, and their biases and angles are known to nothing better
    # than the priors: 10 m/s² times the tilt, 0.05 rad.
    imu = Imu(np.random.default_rng(8), noise=MPU6050, bias=(0.02, 1e-5))
    lean = np.radians(tilt) * np.array([[0, 0.8, -0.6], [0, 0.6, 0.8]])
    estimate = solved(rests(imu, FACES[:2] + lean, 60, 0.0))
    assert np.flatnonzero(estimate.determined[:FREE]).tolist() == [0, 6]
    error = np.abs(estimate.values[:FREE] - imu.free)[[0, 6]]
    assert (error < 2 * estimate.sigma[[0, 6]]).all()
    assert estimate.sigma[6] < 0.1 + 10 * np.radians(tilt)


# ---- imu_tk's convention


def upper_triangular(symmetric):
    """The same triad with M = P R upper triangular, (3, 3)."""
    upper = rq(symmetric, mode="r")
    return upper * np.sign(np.diag(upper))


def test_the_upper_triangular_form_is_the_same_triad():
    symmetric = matrix_of(np.array([1.01, 0.99, 1.02, 0.003, -0.005, 0.008]))
    upper = upper_triangular(symmetric)
    np.testing.assert_allclose(np.tril(upper, -1), 0, atol=1e-15)
    np.testing.assert_allclose(upper @ upper.T, symmetric @ symmetric, atol=1e-15)
    rest = mounting_and_symmetric(upper)[3:]
    np.testing.assert_allclose(rest, [symmetric[i, j] - (i == j) for i, j in PAIRS], atol=1e-12)
    # For small errors: the diagonal is the same, and the corner is twice the angle of P.
    np.testing.assert_allclose(upper[0, 1], 2 * symmetric[0, 1], rtol=0.05)


# ---- mpu6050_cuyo: 37 s at rest, then nine positions by hand

RESTS = [
    *((0, 3710), (4250, 4360), (4850, 5030), (5530, 5770), (6110, 6450)),
    *((7060, 7140), (7510, 7840), (8260, 8540), (9030, 9250), (9570, 10245)),
]
COUNT = 9.80665 / 16384  # m/s²
DENSITY = np.array([0.0034, 0.0030, 0.0045])  # m/s²/√Hz, as the noise stage finds it


@pytest.fixture(scope="module")
def cuyo(recordings):
    folder = recordings / "mpu6050_cuyo"
    log = folder / "example_data_calibration.csv"
    forces = COUNT * np.loadtxt(log, delimiter=",", skiprows=5)[:, :3]
    found = [
        FreeRest(
            str(first), forces[first:after].mean(axis=0), DENSITY / np.sqrt((after - first) / 100)
        )
        for first, after in RESTS
    ]
    return found, np.loadtxt(folder / "params_acc.csv")


def published(parameters):
    """Their f = T K (counts + bias) as P and bias: T = [1 −α_yz α_zy; 0 1 −α_zx; 0 0 1]."""
    (yz, zy, zx), scale, bias = np.split(parameters, [3, 6])
    skew = np.array([[1, -yz, zy], [0, 1, -zx], [0, 0, 1]])
    matrix = np.linalg.inv(skew @ np.diag(scale)) * COUNT
    symmetric = mounting_and_symmetric(matrix)[3:] + PRIOR[:6]  # P − I and I
    return np.append(symmetric, -bias * COUNT)


def test_cuyo_agrees_with_the_published_parameters(cuyo):
    found, theirs = cuyo
    estimate = free_positions(found, 9.80665, 5e-4)  # they took standard gravity
    assert estimate.degrees == 1 and estimate.p_value() > 0.05
    told = estimate.determined[:FREE]
    assert [name for name, is_told in zip(NAMES, told, strict=True) if not is_told] == [
        "symmetric_xy"
    ]
    pulls = (published(theirs) - estimate.values[:FREE]) / estimate.sigma[:FREE]
    assert np.abs(pulls[told]).max() < 2.5
    # Scale factors are told to 0.1 %, and the bias of z, 0.11 g, to 3 mm/s².
    assert (estimate.sigma[:3] < 1.5e-3).all() and estimate.sigma[8] < 3e-3
    assert estimate.values[8] == pytest.approx(-1.1014, abs=8e-3)


def test_cuyo_at_the_gravity_of_mendoza_differs_from_the_published_by_the_ratio_of_gravities(cuyo):
    found, _ = cuyo
    there = free_positions(found, 9.793264, 5e-4).values[:3]
    ratio = free_positions(found, 9.80665, 5e-4).values[:3] / there
    np.testing.assert_allclose(ratio, 9.793264 / 9.80665, rtol=2e-6)  # 1365 ppm


def test_cuyo_names_the_angle_that_its_positions_do_not_tell(cuyo):
    found, theirs = cuyo
    estimate = free_positions(found, 9.80665, 5e-4)
    assert named(estimate) == {("symmetric_xy",): (1, 1, 0)}
    # The published angles are those that the search began with, 1e-5 rad and less.
    assert np.abs(theirs[:3]).max() < 2e-5
