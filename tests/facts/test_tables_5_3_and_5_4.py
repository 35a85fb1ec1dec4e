"""S0, tables 5-3 and 5-4: what the variances of the parameters tell of the noise (T8, T25)."""

import numpy as np
import pytest
import s0

from inertial.estimation.accelerometer_formulas import six_position_formula
from inertial.estimation.accelerometers import Reference, StaticForce, weighted

# Noise of each sensor (rows) in each pair of positions, m/s² per sample: by six positions,
# for single epochs var(M_rk) = σ_rk² / (2 g²), and the variance of the bias is Σ σ_rk² / 18.
NOISE = s0.GRAVITY * np.sqrt(2 * s0.SINGLE_EPOCHS)
OF_BIAS = np.sum(NOISE**2, axis=1) / 18


def six_epochs() -> list[StaticForce]:
    """One epoch of each of the six positions, with the noise of table 5-4."""
    rests = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            up = sign * np.eye(3)[axis]
            mean = s0.ACCELEROMETER @ up * s0.GRAVITY + s0.ACCELEROMETER_BIAS
            rests.append(StaticForce(f"{axis}{sign}", up, mean, NOISE[:, axis]))
    return rests


def test_t8_the_noise_of_each_attitude():
    printed = [[1.0252, 1.0211, 1.5526], [6.1006, 1.0983, 8.7963], [1.5303, 6.2510, 1.0719]]
    np.testing.assert_allclose(NOISE * 1e3, printed, atol=6e-5)
    # The axis that stands upright is the quietest of all: what is more is sway of the table.
    upright = np.diag(NOISE)[:, None]
    excess = np.sqrt(np.abs(NOISE**2 - upright**2))[[1, 1, 2], [0, 2, 1]]
    np.testing.assert_allclose(excess * 1e3, [6.01, 8.73, 6.16], atol=0.01)


def test_t8_the_variances_of_the_bias_follow_from_it():
    np.testing.assert_allclose(s0.SINGLE_EPOCHS_BIAS / OF_BIAS, [0.960, 0.970, 1.000], atol=5e-4)
    unknowns, covariance = six_position_formula(six_epochs(), s0.GRAVITY, 0.0, 0.0)
    np.testing.assert_allclose(unknowns, np.append(s0.ACCELEROMETER, s0.ACCELEROMETER_BIAS))
    variances = np.diag(covariance)
    np.testing.assert_allclose(variances[9:], OF_BIAS, rtol=1e-9)
    np.testing.assert_allclose(variances[:9].reshape(3, 3), s0.SINGLE_EPOCHS, rtol=1e-9)


def test_t25_what_weights_gain():
    _, covariance = six_position_formula(six_epochs(), s0.GRAVITY, 0.0, 0.0)
    fit = weighted(six_epochs(), Reference(s0.GRAVITY, 1e-12, 1e-12))
    gain = np.sqrt(np.diag(covariance)[9:]) / fit.sigma[9:12]
    np.testing.assert_allclose(gain, [1.079, 3.343, 2.501], atol=1e-3)
    # Opposite positions of equal noise: scale factors and cross terms gain nothing.
    np.testing.assert_allclose(fit.sigma[:9], np.sqrt(np.diag(covariance)[:9]), rtol=1e-6)


def test_running_means_of_white_noise_scatter_more_than_those_with_x_up_and_down():
    """Table 5-3 is how a running mean moves, no sigma of its end; and not all of it is white."""
    random = np.random.default_rng(5)
    n = 30_000
    white = random.standard_normal((150, n))
    running = np.cumsum(white, axis=1) / np.arange(1, n + 1)
    ratios = running.var(axis=1) / white.var(axis=1)
    assert np.median(ratios) == pytest.approx(2.5e-4, rel=0.2)
    observed = s0.RUNNING_MEANS / s0.SINGLE_EPOCHS
    assert observed[0, 1] == pytest.approx(2.73e-4, rel=2e-3)
    # What averages faster than white noise is an oscillation: γ_xy and γ_xz.
    assert observed[1, 0] == pytest.approx(5.23e-6, rel=1e-3)
    assert observed[2, 0] == pytest.approx(2.05e-5, rel=2e-3)
    assert max(observed[1, 0], observed[2, 0]) < ratios.min()
