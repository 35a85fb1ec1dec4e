"""The gyros: S0's turn formulas as printed, and what the joint fit may and may not know."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inertial.estimation.gyroscope_observations import (
    Earth,
    Position,
    RateSegment,
    StaticRate,
    SteadyRate,
    WholeTurn,
)
from inertial.estimation.gyroscopes import bias_and_scale, joint
from inertial.estimation.noise_model import SQRT2
from inertial.physics.site import earth_rate

UP, LEVEL = earth_rate(np.radians(30.5278))
EARTH = Earth(UP, 1e-12, LEVEL)


def turn(sign: float, summed: float, seconds: float = 38.0) -> WholeTurn:
    return WholeTurn(summed, sign * 2 * np.pi, 1e-9, seconds, 1.0, 3.5e-6)


def test_two_turns_give_the_formulas_of_the_report():
    # S0 (3-9), (3-10), with the x gyro of table 5-2.
    bias, scale = 2.96905e-07, 6.15071e-04
    forward = (1 + scale) * 2 * np.pi + (bias + UP) * 38
    backward = -(1 + scale) * 2 * np.pi + (bias + UP) * 38
    by_formula = (forward + backward) / (2 * 38) - UP, (forward - backward) / (4 * np.pi) - 1
    fit = bias_and_scale([turn(1, forward), turn(-1, backward)], EARTH)
    np.testing.assert_allclose(fit.values[:2], by_formula, rtol=1e-6)
    np.testing.assert_allclose(fit.values[:2], [bias, scale], rtol=1e-6)
    # σ_b = N/√(2t): S0's formula sees the noise of both turns.
    assert fit.sigma[0] == pytest.approx(3.5e-6 / np.sqrt(76), rel=1e-4)
    assert fit.sigma[1] == pytest.approx(3.5e-6 * np.sqrt(76) / (4 * np.pi), rel=1e-4)


def campaign(directions: tuple[float, ...], rng: np.random.Generator, M: np.ndarray, bias):
    """Six rests and turns about x, y, z, with exact physics but for the noise."""
    noise = 3.5e-6
    rests, turns = [], []
    for axis in range(3):
        for sign in (1.0, -1.0):
            up = sign * np.eye(3)[axis]
            level = np.cross(up, np.eye(3)[(axis + 1) % 3])
            sigma = np.full(3, noise / np.sqrt(300))
            truth = UP * up + LEVEL * level
            mean = M @ truth + bias + sigma * rng.standard_normal(3)
            rests.append(StaticRate(Position(f"{axis}{sign}", up), mean, sigma, up))
        up = np.eye(3)[axis]
        for direction in directions:
            seconds = np.full(190, 0.2)
            rate = np.interp(np.arange(190), [0, 10, 180, 190], [0, 1, 1, 0])
            rate *= direction * 2 * np.pi / rate.sum()
            angle = np.cumsum(rate) - rate / 2
            level = np.cross(up, np.eye(3)[(axis + 1) % 3])
            side = np.cross(up, level)
            north = LEVEL * (np.outer(np.cos(angle), level) - np.outer(np.sin(angle), side))
            truth = np.outer(rate, up) + 0.2 * (UP * up + north)
            sums = truth @ M.T + 0.2 * bias + noise * np.sqrt(0.2) * rng.standard_normal((190, 3))
            density = np.full(3, noise)
            position = Position(f"turn {axis} {direction}", up)
            turns.append(
                RateSegment(
                    position, up, direction * 2 * np.pi, 1e-5, sums, seconds, density, density
                )
            )
    return rests, turns


@pytest.mark.parametrize("directions", [(1.0, -1.0), (1.0,), (-1.0,)])
def test_the_truth_comes_back_also_from_turns_of_one_direction(directions):
    rng = np.random.default_rng(7)
    M = np.eye(3) + 5e-3 * rng.standard_normal((3, 3))
    bias = 1e-5 * rng.standard_normal(3)
    rests, turns = campaign(directions, rng, M, bias)
    fit = joint(rests, turns, [], EARTH, 1e-5)
    pulls = (fit.values[:12] - np.append(M.ravel(), bias)) / fit.sigma[:12]
    assert fit.determined[:12].all()
    assert np.abs(pulls).max() < 4
    assert fit.sigma[0] < 1e-5  # a scale factor to 10 ppm
    assert fit.p_value() > 1e-3


@pytest.mark.parametrize("quantisation", [1e-6, 1e-5, 1e-4])
def test_white_noise_of_the_angle_is_that_of_the_ends_of_a_turn(quantisation: float):
    """An error at each edge of the blocks, of opposite sign in both: of a turn, 2 Q² remain.

    As independent errors of the blocks it would make all cross terms as uncertain as 190 turns.
    """
    rng = np.random.default_rng(9)
    M = np.eye(3) + 5e-3 * rng.standard_normal((3, 3))
    bias = 1e-5 * rng.standard_normal(3)
    rests, turns = campaign((1.0, -1.0), rng, M, bias)
    white = joint(rests, turns, [], EARTH, 1e-5)
    read = quantisation * np.array([1.0, 0.5, 2.0])  # axes differ
    noisy = []
    for turn_ in turns:
        edges = read * rng.standard_normal((len(turn_.sums) + 1, 3))
        noisy.append(replace(turn_, sums=turn_.sums + np.diff(edges, axis=0), quantisation=read))
    fit = joint(rests, noisy, [], EARTH, 1e-5)
    pulls = (fit.values[:12] - np.append(M.ravel(), bias)) / fit.sigma[:12]
    assert np.abs(pulls).max() < 4
    assert fit.p_value() > 1e-3
    ends = np.hypot(1, SQRT2 * read.max() / (3.5e-6 * np.sqrt(38)))  # beside the white noise
    assert (fit.sigma[:9] < 1.2 * ends * white.sigma[:9]).all()
    assert (fit.sigma[:12] >= white.sigma[:12] * (1 - 1e-9)).all()


@pytest.mark.parametrize("whole", [True, False])
def test_while_an_imu_turns_about_a_level_axis_the_vertical_earth_rate_turns_in_it(whole):
    """It stood still there: a position that leans by 14" was named in a clean campaign.

    By turns from rest to rest, or by their middles at a known rate.
    """
    rng, noise = np.random.default_rng(8), 3.5e-6
    M = np.eye(3) + 5e-3 * rng.standard_normal((3, 3))
    bias = 1e-5 * rng.standard_normal(3)
    rests, turns = campaign((1.0, -1.0), rng, M, bias)
    steadies = []
    for axis in range(3):
        up, about, level = np.roll(np.eye(3), -axis, axis=0)
        for sign in (1.0, -1.0):
            count = 190 if whole else 160  # not in whole turns
            rate = np.full(count, sign * 2 * np.pi / 190)
            angle = np.cumsum(rate) - rate / 2
            turning = Rotation.from_rotvec(-np.outer(angle, about))
            truth = np.outer(rate, about) + 0.2 * turning.apply(UP * up + LEVEL * level)
            sums = truth @ M.T + 0.2 * bias + noise * np.sqrt(0.2) * rng.standard_normal((count, 3))
            position, density = Position(f"lying {axis} {sign}", up), np.full(3, noise)
            seconds = np.full(count, 0.2)
            if whole:
                given = (sign * 2 * np.pi, 1e-5, sums, seconds, density, density)
                turns.append(RateSegment(position, about, *given))
            else:
                mean, elapsed = sums.mean(axis=0) / 0.2, np.cumsum(seconds) - 0.1
                known = (rate[0] / 0.2, 1e-9, seconds, elapsed, mean, noise / np.sqrt([32] * 3))
                steadies.append(SteadyRate(position, about, *known))
    fit = joint(rests, turns, steadies, EARTH, 1e-5)
    pulls = (fit.values[:12] - np.append(M.ravel(), bias)) / fit.sigma[:12]
    assert np.abs(pulls).max() < 4
    assert fit.p_value() > 1e-3


def test_without_turns_the_scale_factors_are_barely_known():
    """Noise alone would leave 0.4 %, but azimuths and cross terms are free.

    With M drawn as it is known beforehand the sigmas hold. By equations that neglected the product
    of a cross term and the level rate errors were 16 times their sigma, and twice for M = 1.
    """
    noise = 3.5e-6 / np.sqrt(300) / np.sqrt(2) / UP
    pulls = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        matrix = np.eye(3) + 0.1 * rng.standard_normal((3, 3))
        fit = joint(campaign((), rng, matrix, np.zeros(3))[0], [], [], EARTH, 1e-5)
        assert (10 * noise < fit.sigma[[0, 4, 8]]).all() and not fit.determined[[0, 4, 8]].any()
        pulls += ((fit.values[:9] - matrix.ravel()) / fit.sigma[:9])[[0, 4, 8]].tolist()
    assert 0.8 < np.sqrt(np.mean(np.square(pulls))) < 1.2


def test_a_gap_taken_for_a_whole_turn_would_be_a_sixth_of_the_scale():
    """What the refusal of an incomplete turn prevents: S0's 11.98 s, as 360° or as 240°."""
    forward = 2 * np.pi
    backward = -2 * np.pi + np.radians(119.8)
    wrong = bias_and_scale([turn(1, forward), turn(-1, backward)], EARTH)
    assert wrong.values[1] == pytest.approx(-0.166389, rel=1e-4)


def test_the_rate_of_a_clock_is_one_error_of_all_turns_of_its_log():
    """σ² of each scale factor grows by σ_c² in one log, and by σ_c²/2 where both turns have one."""
    rng = np.random.default_rng(3)
    rests, turns = campaign((1.0, -1.0), rng, np.eye(3), np.zeros(3))
    timed = 2e-4

    def fitted(clocks: list[str]):
        own = [replace(t, clock=c, clock_sigma=timed) for t, c in zip(turns, clocks, strict=True)]
        return joint(rests, own, [], EARTH, 1e-5)

    certain = joint(rests, turns, [], EARTH, 1e-5)
    common, apart = fitted(["log"] * 6), fitted([f"log {i}" for i in range(6)])
    scales, biases, crosses = [0, 4, 8], [9, 10, 11], [1, 2, 3, 5, 6, 7]
    for fit, share in ((common, 1.0), (apart, 0.5)):
        expected = np.hypot(certain.sigma[scales], np.sqrt(share) * timed)
        np.testing.assert_allclose(fit.sigma[scales], expected, rtol=0.02)
        np.testing.assert_allclose(fit.sigma[crosses], certain.sigma[crosses], rtol=0.02)
        np.testing.assert_allclose(fit.sigma[biases], certain.sigma[biases], rtol=0.05)
    correlated = common.covariance[0, 4] / (common.sigma[0] * common.sigma[4])
    # By the size of the level rate, which rests show to 0.1 %, all know a little more than that.
    assert correlated == pytest.approx((timed / common.sigma[0]) ** 2, rel=0.05)

    whole = [
        WholeTurn(s * 2 * np.pi, s * 2 * np.pi, 1e-9, 38.0, 1.0, 3.5e-6, c, timed)
        for s, c in ((1, "a"), (-1, "b"))
    ]
    assert bias_and_scale(whole, EARTH).sigma[1] == pytest.approx(timed / np.sqrt(2), rel=1e-3)
    alone = [replace(turn, clock="a") for turn in whole]
    assert bias_and_scale(alone, EARTH).sigma[1] == pytest.approx(timed, rel=1e-3)
