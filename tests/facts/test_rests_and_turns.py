"""S0, tables 5-2, 5-7, 5-8: gyros by rests against gyros by turns (T14 to T16)."""

import numpy as np
import pytest
import s0
from scipy.stats import chi2

from inertial.estimation.consistency import common_cause
from inertial.estimation.gyroscope_formulas import Upright, two_positions
from inertial.estimation.gyroscope_observations import Earth, Position, WholeTurn
from inertial.estimation.gyroscopes import bias_and_scale
from inertial.physics.site import earth_rate

UP, LEVEL = earth_rate(s0.LATITUDE)
WUHAN = Earth(UP, 0.0, LEVEL)
DEGREE_PER_HOUR = np.radians(1 / 3600)


def rests(walk: float, seconds: float) -> list[Upright]:
    """One axis up and down, with the noise of an angle random walk in °/√h."""
    sigma = s0.per_root_second(np.radians(walk)) / np.sqrt(seconds)
    ups = {sign: Position(f"{sign}", np.array([sign, 0.0, 0.0])) for sign in (1.0, -1.0)}
    return [Upright(position, sign, UP * sign, sigma) for sign, position in ups.items()]


def sigma_of_difference(walk: float) -> float:
    """Of a bias by turns of 40 s both ways less that by rests of 300 s."""
    density = s0.per_root_second(np.radians(walk))
    turns = [WholeTurn(a, a, 1e-12, 40, 1, density) for a in (2 * np.pi, -2 * np.pi)]
    static = two_positions(rests(walk, 300), np.zeros(3), WUHAN, 0.0)
    return float(np.hypot(bias_and_scale(turns, WUHAN).sigma[0], static.bias_sigma))


DIFFERENCE = s0.TURNS_BIAS - s0.RESTS_BIAS


def test_the_biases_in_degrees_per_hour():
    np.testing.assert_allclose(s0.TURNS_BIAS / DEGREE_PER_HOUR, [0.0612, 0.1478, 0.0751], atol=5e-5)
    np.testing.assert_allclose(
        s0.RESTS_BIAS / DEGREE_PER_HOUR, [-0.0044, -0.1539, -0.1252], atol=5e-5
    )
    np.testing.assert_allclose(DIFFERENCE / DEGREE_PER_HOUR, [0.0657, 0.3017, 0.2003], atol=5e-5)
    # "All within 1e-6 rad/s" is not so for y.
    np.testing.assert_allclose(DIFFERENCE, [3.184e-7, 1.4627e-6, 9.709e-7], atol=6e-11)


def test_t14_turns_and_rests_differ_and_one_cause_suffices():
    sigma = np.full(3, sigma_of_difference(0.012))
    assert sigma[0] == pytest.approx(4.15e-7, abs=1e-9)
    found = common_cause(DIFFERENCE, sigma)
    assert found.without == pytest.approx(18.44, abs=0.01)
    assert found.p_without == pytest.approx(3.6e-4, rel=0.02)
    assert found.amount == pytest.approx(9.17e-7, rel=1e-3)
    assert found.amount / found.sigma == pytest.approx(3.82, abs=0.01)
    assert found.remaining == pytest.approx(3.8, abs=0.05)
    assert chi2.sf(found.remaining, 2) == pytest.approx(0.15, abs=0.005)
    # By the data sheet's noise there would be nothing to explain; suspiciously little.
    spec = common_cause(DIFFERENCE, np.full(3, sigma_of_difference(0.1)))
    assert spec.without == pytest.approx(0.27, abs=0.005) and spec.p_without > 0.95


def test_a_wrong_latitude_would_be_such_a_cause():
    assert np.degrees(9.17e-7 / LEVEL) == pytest.approx(0.84, abs=0.005)
    rounded, _ = earth_rate(np.radians(30))
    assert UP - rounded == pytest.approx(5.80e-7, abs=1e-9)


@pytest.mark.parametrize(
    ("walk", "seconds", "sigma", "chi_squared"),
    [
        (0.1, 120, 0.0507, 0.49),
        (0.1, 300, 0.0321, 1.22),
        (0.03, 120, 0.0152, 5.41),
        (0.03, 300, 0.0096, 13.5),
    ],
)
def test_t15_scale_factors_by_rests_say_what_noise_says(walk, seconds, sigma, chi_squared):
    static = two_positions(rests(walk, seconds), np.zeros(3), WUHAN, 0.0)
    assert static.scale_sigma == pytest.approx(sigma, abs=6e-5)
    found = float(np.sum((s0.RESTS_SCALE / static.scale_sigma) ** 2))
    assert found == pytest.approx(chi_squared, rel=0.007)
    if walk == 0.1:  # the data sheet's: no evidence of any scale factor
        assert chi2.sf(found, 3) > 0.7


@pytest.mark.parametrize("cross", [1e-3, 7.608e-3, 10e-3])
def test_t16_the_level_earth_rate_passes_a_cross_term_into_the_scale_factor(cross):
    """γ ω_e cosφ / (ω_e sinφ) = γ/tanφ: 1.696e-3 per mrad."""
    norths = [np.array([0.0, sign, 0.0]) for sign in (1.0, -1.0)]
    coupled = LEVEL * cross
    means = (UP + coupled, -UP - coupled)
    turned_over = [
        Upright(r.position, r.up, mean, r.sigma)
        for r, mean in zip(rests(1e-6, 300), means, strict=True)
    ]
    row = np.array([0.0, cross, 0.0])
    blind = two_positions(turned_over, row, WUHAN, 0.0)
    printed = {1e-3: 1.696e-3, 7.608e-3: 0.01290, 10e-3: 0.01696}[cross]
    assert blind.scale == pytest.approx(printed, rel=5e-4)
    assert abs(blind.scale) < 3 * blind.scale_sigma  # it is in the sigma of an unknown azimuth
    north = [
        Upright(Position("", r.position.up, north=n), r.up, r.mean, r.sigma)
        for r, n in zip(turned_over, norths, strict=True)
    ]
    assert two_positions(north, row, WUHAN, 0.0).scale == pytest.approx(0, abs=1e-9)


def test_t16_what_misalignment_alone_would_have_to_be():
    needed = s0.RESTS_SCALE * UP / LEVEL
    np.testing.assert_allclose(np.abs(needed), [17.5e-3, 9.9e-3, 5.4e-3], atol=6e-5)
    into_bias = 7.608e-3 * LEVEL / DEGREE_PER_HOUR
    assert into_bias == pytest.approx(0.0986, abs=5e-5)
