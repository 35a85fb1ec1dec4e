"""S0, tables 5-2, 5-5, 5-6: window, whole angle, table speed (T11 to T13, T23)."""

import numpy as np
import pytest
import s0

from inertial.estimation.angle_windows import fencepost
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.estimation.gyroscope_observations import Earth, Position, SteadyRate
from inertial.estimation.rate_table import rate_table
from inertial.estimation.time_angle import ripple_angle
from inertial.physics.site import earth_rate

UP, LEVEL = earth_rate(s0.LATITUDE)
WUHAN = Earth(UP, 0.0, LEVEL)
WINDOW = np.full(3, 1800.0)  # intervals of 10 ms in 180° at 10 °/s
ROUNDED = s0.LAST_DIGIT / np.sqrt(12)  # rad/s, sigma of a printed rate
WALK = s0.per_root_second(np.radians(0.012))  # rad/√s, by the scatter of S0's own results

# Sigma of a scale factor by windows: noise of 18 s each way and of the turns of 40 s, and the 20 Hz
# that both windows cut: 0.01 rad/s on x, 0.001 on y (F 5-14, 5-15); of z none is shown.
OF_NOISE = np.hypot(WALK * np.sqrt(36) / (2 * np.pi), WALK * np.sqrt(80) / (4 * np.pi))
OF_RIPPLE = [ripple_angle(size, 20) / np.pi / np.sqrt(2) for size in (0.01, 0.001, 0.001)]
SIGMA = np.hypot(OF_NOISE, OF_RIPPLE)


def test_t11_the_middle_180_degrees_hold_one_sample_too_many():
    found = fencepost(s0.WINDOWS_SCALE, s0.TURNS_SCALE, SIGMA, WINDOW)
    np.testing.assert_allclose(found.ratios, [580.57e-6, 555.13e-6, 559.74e-6], atol=1e-8)
    left = found.ratios - 1 / WINDOW
    np.testing.assert_allclose(left, [25.02e-6, -0.43e-6, 4.18e-6], atol=1e-8)
    assert found.whole == 1 and found.is_detected(level=0.01)
    assert found.cause.amount == pytest.approx(1, abs=3 * found.cause.sigma)
    assert found.cause.p_without < 1e-12 and found.p_whole > 0.1


@pytest.mark.parametrize(
    "ratios",
    [
        [0.0, 0.0, 0.0],  # nothing
        [580e-6, -20e-6, 300e-6],  # each axis has its own
        [278e-6, 278e-6, 278e-6],  # in common, but half a sample
    ],
)
def test_other_differences_are_no_fencepost(ratios):
    scales = (1 + np.array(ratios)) * (1 + s0.TURNS_SCALE) - 1
    assert not fencepost(scales, s0.TURNS_SCALE, SIGMA, WINDOW).is_detected(level=0.01)


def test_a_fencepost_of_windows_of_other_lengths_has_its_own_form():
    samples = np.array([1800.0, 900.0, 450.0])
    scales = (1 + s0.TURNS_SCALE) * (1 - 1 / samples) - 1
    found = fencepost(scales, s0.TURNS_SCALE, SIGMA, samples)
    assert found.whole == -1 and found.is_detected(level=0.01)
    same = np.full(3, -1 / 900)
    scales = (1 + s0.TURNS_SCALE) * (1 + same) - 1
    assert not fencepost(scales, s0.TURNS_SCALE, SIGMA, samples).is_detected(level=0.01)


def plateau(gyro: int) -> list[SteadyRate]:
    """The steady parts of the two turns about one axis, as table 5-6 prints their means."""
    up = np.eye(3)[gyro]
    runs = []
    for rate, means in ((s0.RATE, s0.STEADY_FORWARD), (-s0.RATE, s0.STEADY_BACKWARD)):
        mean = np.where(up > 0, means, np.nan)
        runs.append(
            SteadyRate(
                Position("", up),
                up,
                rate,
                0.0,
                seconds=np.full(340, 0.1),
                elapsed=np.arange(0.05, 34, 0.1),
                mean=mean,
                sigma=np.full(3, ROUNDED),
            )
        )
    return runs


def test_t12_the_plateau_gives_the_scale_factors_of_the_whole_turns():
    scales, sigmas = [], []
    for gyro in range(3):
        solution = rate_table(plateau(gyro), WUHAN, 0.0).solution
        scales.append(solution.values[4 * gyro] - 1)
        sigmas.append(solution.sigma[4 * gyro])
    np.testing.assert_allclose(scales[1:], [-45.41e-6, 699.44e-6], atol=1e-8)
    np.testing.assert_allclose(sigmas, 11.7e-6, atol=1e-7)
    against_angle = scales - s0.TURNS_SCALE
    np.testing.assert_allclose(against_angle[1:], [-29e-6, 55e-6], atol=5e-7)
    against_window = (scales - s0.WINDOWS_SCALE) / sigmas
    np.testing.assert_allclose(against_window[1:], [-50, -43], atol=0.5)
    # T13: the backward rate of x does not belong there.
    assert scales[0] == pytest.approx(-3082.1e-6, abs=1e-7)


def test_t12_t13_the_speed_of_the_table_is_not_what_the_windows_would_need():
    means = np.append(s0.STEADY_FORWARD, s0.STEADY_BACKWARD)
    rates = s0.RATE * np.repeat([1.0, -1.0], 3)
    scale, scale_sigma = np.tile(s0.TURNS_SCALE, 2), 21e-6  # 40 s both ways, 0.1 °/√h
    offset, offset_sigma = np.tile(s0.TURNS_BIAS, 2) + UP, 3.3e-6
    noise = np.full(6, np.hypot(ROUNDED, s0.per_root_second(np.radians(0.1)) / np.sqrt(34)))
    # The rate of the table is (mean − b − ω_e sinφ) / (1 + s).
    excess = (means - offset) / (1 + scale) / rates - 1
    sigma = np.hypot(np.hypot(noise, offset_sigma) / rates, scale_sigma)
    # What the printed rates differ by from those of table 5-2, with bias and earth.
    difference = excess * (1 + scale) * rates
    np.testing.assert_allclose(difference[:3], [-1.76e-5, 2.1e-6, -2.8e-6], atol=6e-8)
    np.testing.assert_allclose(difference[3:], [1.273e-3, 1.2e-5, -2.2e-5], atol=5e-7)
    # The windows of table 5-5 would need a table that is slow by 556 ppm, all six times.
    others = np.delete(np.arange(6), 3)
    assert np.abs(excess[others]).max() < 130e-6
    assert np.abs(excess[others] + 1 / 1800).min() / sigma.max() > 10
    # T13: x backward is a misprint, or a window that holds a ramp.
    chances = [normal_p_value(e / s) for e, s in zip(excess, sigma, strict=True)]
    assert list(np.flatnonzero(holm_rejections(chances, 1e-3))) == [3]
    assert excess[3] == pytest.approx(-0.00729, abs=1e-5)


def test_t23_what_20_hz_leave_in_a_window():
    # Of the scale factor by 180° that are 25.33 ppm rms; by two windows 17.9.
    assert ripple_angle(0.01, 20) == pytest.approx(7.958e-5, abs=1e-8)
    # The rms is that of sums, too.
    random = np.random.default_rng(23)
    start = random.uniform(0, 1, 4000)
    stop = start + random.uniform(17, 19, 4000)
    angle = 0.01 / (40 * np.pi) * (np.cos(40 * np.pi * start) - np.cos(40 * np.pi * stop))
    assert angle.std() == pytest.approx(ripple_angle(0.01, 20), rel=0.05)
    assert np.abs(angle).max() <= 2 * ripple_angle(0.01, 20)
