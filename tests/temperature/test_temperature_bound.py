"""The bound of curves of the temperature, by numbers that need no program."""

import numpy as np
import pytest
from block_statistics import GRAVITY, Layout, pieces
from study_plans import rest
from temperature_bound import Bound, Curve

SECONDS, NOISE = 100.0, 0.06  # of a rest; m/s/√h
SIGMA = NOISE / 60 / np.sqrt(SECONDS)  # m/s², of the mean of a rest
LEVELS = np.array([-20.0, 0.0, 20.0, 40.0]) + 273.15
TILT = np.radians(2 / 3600)


def bound() -> Bound:
    """x up and x down at four temperatures."""
    plan = [
        rest(f"{i}{way}", sign + "x", SECONDS)
        for i in range(len(LEVELS))
        for way, sign in (("up", "+"), ("down", "-"))
    ]
    return Bound(Layout(pieces(plan)), np.repeat(LEVELS, 2), 0.1, NOISE)


def test_a_bias_of_several_temperatures_is_a_regression() -> None:
    """The mean of up and down at each of four temperatures; tilts matter in second order only."""
    line = Curve(9, "1", 283.15, 30.0)
    sigma = bound().sigmas([line])
    z = (LEVELS - 283.15) / 30
    each = SIGMA / np.sqrt(2)
    assert sigma[9] == pytest.approx(each / 2, rel=1e-6)
    assert sigma[24] == pytest.approx(each / np.sqrt(np.sum(z**2)), rel=1e-6)
    cubic = bound().sigmas([Curve(9, "3", 283.15, 30.0)])
    design = np.vander(z, 4, increasing=True)
    expected = each * np.sqrt(np.diag(np.linalg.inv(design.T @ design)))
    assert cubic[[9, 24, 25, 26]] == pytest.approx(expected, rel=1e-6)
    alone = bound().alone(Curve(9, "3", 283.15, 30.0))
    assert alone == pytest.approx(expected[1:], rel=1e-4)


def test_half_the_difference_of_up_and_down_is_the_scale_factor() -> None:
    """Of a cross term each tilt of 2″ is an error of its own beside the noise."""
    z = (LEVELS - 283.15) / 30
    scale = bound().sigmas([Curve(0, "1", 283.15, 30.0)])[24]
    assert scale == pytest.approx(SIGMA / np.sqrt(2 * np.sum(z**2)) / GRAVITY, rel=1e-5)
    cross = bound().sigmas([Curve(3, "1", 283.15, 30.0)])[24]
    with_tilt = np.hypot(SIGMA / GRAVITY, TILT) / np.sqrt(2 * np.sum(z**2))
    assert cross == pytest.approx(with_tilt, rel=1e-4)


def test_between_the_nodes_of_a_cubic_the_bound_is_that_of_the_interpolation() -> None:
    cubic = Curve(9, "3", 283.15, 30.0)
    at = np.array([273.15, 283.15])  # a node, and between two
    sigma = bound().of_curves([cubic], [np.ones(3)], at)[9]
    weights = [
        np.prod([(at[1] - b) / (a - b) for b in LEVELS if b != a]) for a in LEVELS
    ]  # Lagrange: four points and four unknowns
    each = SIGMA / np.sqrt(2)
    assert sigma == pytest.approx([each, each * np.linalg.norm(weights)], rel=1e-6)


@pytest.mark.slow
def test_an_unknown_knot_costs_nothing_far_from_it_and_more_at_it() -> None:
    knee = Curve(9, "knee", 283.15, 30.0, 290.15)
    known = bound().sigmas([knee])[25]
    at = np.array([290.15])
    small, large = (
        bound().of_curves([knee], [np.array([0.0, bend])], at)[9, 0]
        for bend in (known, 1e3 * known)
    )
    line = bound().of_curves([Curve(9, "1", 283.15, 30.0)], [np.zeros(1)], at)[9, 0]
    assert line < small <= large * (1 + 1e-9)
