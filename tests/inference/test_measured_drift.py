"""Drift that the noise at rest shows: its covariance, and that it enters once, axis by axis."""

import numpy as np
import pytest
from inference.walking import DEGREE_PER_HOUR, EARTH, TILT, UNIT, campaign
from scipy.integrate import quad

from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.elimination import EquationBlock
from inertial.estimation.gyroscopes import fit, joint
from inertial.estimation.noise_model import wave, waves_within
from inertial.estimation.random_walk import (
    COMMON_CLOCK,
    NO_DRIFT,
    MeasuredDrift,
    Stretch,
    measured_covariance,
)

STRETCHES = [
    Stretch(str(i), COMMON_CLOCK, start, seconds)
    for i, (start, seconds) in enumerate(
        [(0, 300), (360, 300), (720, 40), (765, 200), (2000, 300), (3000, 300)]
    )
]
B = MeasuredDrift(np.array([2.0, 0.0, 0.0]), np.zeros(3))


def variance_of_difference(one: Stretch, other: Stretch) -> float:
    """Of two means of a noise of the density B²/(2π f), both sides, with B = 2."""

    def density(log_frequency):
        f = np.exp(log_frequency)
        weight = [
            np.sinc(f * s.seconds) * np.exp(2j * np.pi * f * (s.start + s.seconds / 2))
            for s in (one, other)
        ]
        return 2 * 2.0**2 / (2 * np.pi) * abs(weight[0] - weight[1]) ** 2

    return quad(density, np.log(1e-8), np.log(0.1), limit=2000, epsrel=1e-3)[0]


def test_means_differ_as_the_spectrum_of_the_instability_says():
    covariance = measured_covariance(STRETCHES, B)
    assert not covariance[1:].any()
    of_x = covariance[0]
    for i, one in enumerate(STRETCHES):
        for j, other in enumerate(STRETCHES[:i]):
            difference = of_x[i, i] + of_x[j, j] - 2 * of_x[i, j]
            assert difference == pytest.approx(variance_of_difference(one, other), rel=0.07)


def test_adjacent_means_have_the_allan_deviation_of_ieee_952():
    """B √(2 ln 2/π) = 0.664 B at every averaging time."""
    for seconds in (10.0, 80.0):
        some = [Stretch(str(i), COMMON_CLOCK, i * seconds, seconds) for i in range(32)]
        of_x = measured_covariance(some, B)[0]
        pairs = [of_x[i, i] + of_x[i + 1, i + 1] - 2 * of_x[i, i + 1] for i in range(31)]
        assert np.sqrt(np.mean(pairs) / 2) == pytest.approx(0.664 * 2.0, rel=0.02)


def test_drawn_flicker_noise_scatters_as_said():
    """Noise that is shaped in the frequency domain, which is no sum of Gauss-Markov processes."""
    rng, samples, step = np.random.default_rng(2), 2**14, 2.0
    frequency = np.fft.rfftfreq(samples, step)
    shape = np.zeros(len(frequency))
    shape[1:] = np.sqrt(2.0**2 / (2 * np.pi * frequency[1:]) / step)
    white = np.fft.rfft(rng.standard_normal((400, samples)))
    drawn = np.fft.irfft(white * shape, samples)
    places = [slice(int(s.start / step), int((s.start + s.seconds) / step)) for s in STRETCHES]
    means = np.array([drawn[:, place].mean(axis=1) for place in places])
    found = np.cov(means - means[2])
    change = np.eye(6) - np.eye(6)[2]
    expected = change @ measured_covariance(STRETCHES, B)[0] @ change.T
    kept = [0, 1, 3, 4, 5]
    ratio = np.linalg.solve(expected[np.ix_(kept, kept)], found[np.ix_(kept, kept)])
    assert np.trace(ratio) / 5 == pytest.approx(1, abs=0.08)  # 400 draws of 5: known to 3 %


@pytest.mark.parametrize("one_clock", [True, False])
def test_eliminated_drifts_are_the_covariance_of_each_axis(one_clock):
    """Equations with drifts, their likelihood, and the dense covariance say the same."""
    rng = np.random.default_rng(1)
    measured = MeasuredDrift(np.array([3.0, 0.0, 1.0]), np.array([0.05, 0.1, 0.0]))
    scatter, walk, sigma = 2.0, 0.03, 1.5
    stretches = [s if one_clock else Stretch(s.name, s.name, s.start, s.seconds) for s in STRETCHES]
    observed = 10 * rng.standard_normal((6, 3))
    blocks = [
        (EquationBlock(np.column_stack([np.eye(3), mean]) / sigma, (), 3, 6 * np.log(sigma)), s)
        for mean, s in zip(observed, stretches, strict=True)
    ]
    positions = [s.name for s in stretches]
    about = ({}, np.zeros(3), np.full(3, 1e6), tuple(("bias", a) for a in "xyz"), 0, 3)
    equations = DriftingEquations(blocks, positions, *about, measured=measured)
    found = equations.system(scatter, walk).solve_shared()
    both = measured_covariance(stretches, measured)
    both += measured_covariance(stretches, MeasuredDrift(np.zeros(3), np.full(3, walk)))
    deviance = 0.0
    for axis, drift in enumerate(both):
        covariance = drift + (scatter**2 + sigma**2) * np.eye(6)
        information = np.linalg.inv(covariance)
        mean = information.sum(axis=0) @ observed[:, axis] / information.sum()
        assert found.values[axis] == pytest.approx(mean, rel=1e-6)
        assert found.sigma[axis] == pytest.approx(information.sum() ** -0.5, rel=1e-6)
        left = observed[:, axis] - mean
        deviance += np.linalg.slogdet(covariance)[1] + left @ information @ left
        deviance += np.log(1 + 1e12 * information.sum())
    assert found.deviance == pytest.approx(deviance, rel=1e-6)
    likelihood = equations.likelihood
    assert likelihood.of_both(scatter, walk) == pytest.approx(deviance, rel=1e-6)
    alone = equations.system().solve_shared().deviance
    assert likelihood.of_walk()(0.0) == pytest.approx(alone, rel=1e-6)
    assert likelihood.of_scatter()(0.0) == pytest.approx(alone, rel=1e-6)


def test_a_measured_walk_is_not_estimated_again_and_the_bias_keeps_its_sigma():
    size = 0.5 * UNIT
    measured = MeasuredDrift(np.zeros(3), np.full(3, size))
    pulls = []
    for seed in range(6):
        run = campaign(seed, size)
        found = fit(run.stills, run.turns, [], EARTH, TILT, measured=measured)
        assert found.random_walk == 0 and found.scatter == 0
        pulls.append((found.estimate.values[9:12] - run.bias) / found.estimate.sigma[9:12])
    assert 0.6 < np.std(pulls) < 1.45  # of 18
    assert joint(run.stills, run.turns, [], EARTH, TILT).sigma[9] < found.estimate.sigma[9] / 2


def test_a_drift_of_one_axis_leaves_the_others_as_they_are():
    run = campaign(3)
    drifting = MeasuredDrift(np.array([0.2 * DEGREE_PER_HOUR, 0, 0]), np.array([UNIT, 0, 0]))
    quiet, noisy = (
        joint(run.stills, run.turns, [], EARTH, TILT, measured=each).sigma[9:12]
        for each in (NO_DRIFT, drifting)
    )
    assert noisy[0] > 2 * quiet[0]
    np.testing.assert_allclose(noisy[1:], quiet[1:], rtol=0.02)


def test_within_a_stretch_the_bias_goes_as_flicker_noise_does():
    """The means of the two halves differ by the Allan variance of 1/f noise, 2 ln 2/π B² (IEEE)."""
    sigma = waves_within(40.0, np.array([2.0]), np.array([1e-3]))[:, 0]
    middle = (np.arange(4000) + 0.5) / 4000
    halves = [2 * float(wave(k, middle)[:2000].mean()) for k in range(1, len(sigma) + 1)]
    variance = float(np.square(halves) @ np.square(sigma))
    assert variance / 2 == pytest.approx(2 * np.log(2) / np.pi * 2.0**2, rel=0.05)


def test_waves_that_are_less_than_the_white_noise_are_left_out():
    """1 °/h and 0.0667 °/√h, 40 s: S(k/2T)/T = B²/(π k) is a tenth of N²/T at k = 8."""
    degree = np.pi / 180
    white = np.array([0.0667 * degree / 60, np.nan, 0.0667 * degree / 60])
    sigma = waves_within(40.0, np.array([1, 0, 0.5]) * degree / 3600, white)
    assert sigma.shape == (7, 3) and (sigma[:, 1] == 0).all()
    assert not len(waves_within(40.0, np.zeros(3), white))
