"""Parts of the variances in closed form: six positions of accelerometers, switch-ons of gyros."""

import chain
import numpy as np
import pytest

from inertial.campaign.equations import PRIOR_SIZE
from inertial.campaign.observations import campaign_of
from inertial.estimation.accelerometers import Reference, StaticForce, drifting
from inertial.estimation.gyroscope_equations import Linearisation
from inertial.estimation.gyroscope_observations import Earth, Position, SteadyRate
from inertial.estimation.gyroscopes import linearised
from inertial.estimation.uncertainty_budget import Model, budget
from inertial.physics.forward import Triad

GRAVITY, NOISE, GRAVITY_SIGMA, TILT = 9.8, 3e-5, 5e-5, 1e-5
SCALE_X, CROSS_XY, BIAS_X = 0, 1, 9


@pytest.fixture(scope="module")
def parts():
    ups = np.vstack([np.eye(3), -np.eye(3)])
    statics = [
        StaticForce(f"p{i}", up, GRAVITY * up, np.full(3, NOISE)) for i, up in enumerate(ups)
    ]
    reference, about = Reference(GRAVITY, GRAVITY_SIGMA, TILT), Triad(np.eye(3), np.zeros(3))
    return budget(Model(drifting(statics, reference, about, walking=False)))


def test_the_parts_add_up(parts):
    whole, each = parts
    assert {*each} == {"noise", "position", "gravity"}
    np.testing.assert_allclose(sum(each.values()), whole, rtol=1e-3)


def test_gravity_is_in_the_scale_factors_alone(parts):
    """s = (f₊ − f₋)/(2 g) − 1: noise σ²/(2 g²), gravity (σ_g/g)², tilts of second order."""
    _whole, each = parts
    scale = {source: part[SCALE_X] for source, part in each.items()}
    assert scale["gravity"] == pytest.approx((GRAVITY_SIGMA / GRAVITY) ** 2, rel=1e-3)
    assert scale["noise"] == pytest.approx(NOISE**2 / (2 * GRAVITY**2), rel=1e-3)
    assert scale["position"] < 1e-6 * scale["noise"]


def test_a_cross_term_has_the_tilts_of_two_positions(parts):
    """m_xy = (f₊ − f₋)/(2 g) with ±y up: noise σ²/(2 g²), tilts δ²/2."""
    _whole, each = parts
    assert each["position"][CROSS_XY] == pytest.approx(TILT**2 / 2, rel=1e-3)
    assert each["noise"][CROSS_XY] == pytest.approx(NOISE**2 / (2 * GRAVITY**2), rel=1e-3)
    assert each["gravity"][CROSS_XY] < 1e-6 * TILT**2


def test_a_bias_weighs_upright_positions_against_level_ones(parts):
    """Upright: two readings of variance σ²; level: four of σ² + (g δ)²; the mean of both."""
    _whole, each = parts
    tilted = (GRAVITY * TILT) ** 2
    upright, level = 2 / NOISE**2, 4 / (NOISE**2 + tilted)
    share = level / (upright + level)
    noise = NOISE**2 * ((1 - share) ** 2 / 2 + share**2 / 4)
    assert each["noise"][BIAS_X] == pytest.approx(noise, rel=1e-3)
    assert each["position"][BIAS_X] == pytest.approx(tilted * share**2 / 4, rel=1e-3)


def test_a_scale_factor_by_known_rates_has_the_share_by_which_all_of_them_are_off():
    """s = (ω₊ − ω₋)/(2 ω) − 1 of two runs about each axis: own errors ρ²/2, of the table τ²."""
    rate, own, table, noise = 0.5, 2e-4, 1e-4, 1e-6
    runs = [
        SteadyRate(
            Position(f"{i}", np.eye(3)[i]),
            np.eye(3)[i],
            signed,
            rate * own,
            np.full(9, 2.0),
            np.arange(9) * 2.0,
            signed * np.eye(3)[i],
            np.full(3, noise),
            table_rate_sigma=rate * table,
        )
        for i in range(3)
        for signed in (rate, -rate)
    ]
    about = Linearisation(np.eye(3), np.zeros(3), {})
    equations = linearised(about, [], runs, Earth(3e-5, 1e-12, 6e-5), 1e-9)
    whole, each = budget(Model(equations.with_statics([]).drifting()))
    assert sum(each.values()) == pytest.approx(whole, rel=1e-3)
    for scale in (0, 4, 8):
        assert each["rate"][scale] == pytest.approx(own**2 / 2, rel=0.01)
        assert each["table_rate"][scale] == pytest.approx(table**2, rel=0.01)


@pytest.mark.slow
def test_a_bias_has_the_mean_over_its_switch_ons():
    """Eight switch-ons of equal weight: the variance of a bias has τ²/8 of each."""
    document = chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    made = chain.in_memory_of(document)
    (data,) = chain.mounts(made)
    equations = campaign_of(data).equations("gyro", [], PRIOR_SIZE)
    assert equations is not None
    whole, shares = budget(Model(equations))
    assert sum(shares.values()) == pytest.approx(whole, rel=1e-3)
    fit = made["gyroscope/fit"].set_index("method").loc["joint"]
    size = np.array([fit[f"switch_on_{axis}"] for axis in "xyz"])
    student = size * 2.3646 / 1.9600  # of 7 degrees, two-sided 95 %
    assert np.sqrt(shares["switch_on"][9:]) == pytest.approx(student / np.sqrt(8), rel=0.1)
