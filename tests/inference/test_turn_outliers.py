"""A turn that was not what is stated, by the others: of rates a line, of angles one ratio."""

import numpy as np
import pytest

from inertial.campaign.recorded_turns import off_rate, off_ratio

RATES = np.radians([10.0, -10, 30, -30, 60, -60])
SIGMA = np.full(6, 1e-6)


def read(rates, cubic=0.0, asymmetry=0.0):
    """By a bias of 36 °/h, a scale error of 3 %, and what is not linear."""
    noise = np.random.default_rng(5).normal(0, 1e-6, len(rates))
    law = cubic * rates**3 + asymmetry * np.abs(rates)
    return np.radians(0.01) + 1.03 * rates + law + noise


@pytest.mark.parametrize(("run", "rate"), [(2, 30.9), (5, -61.0), (0, 10.1)])
def test_the_run_at_another_rate_is_told_with_its_rate(run, rate):
    turned = RATES.copy()
    turned[run] = np.radians(rate)
    found = off_rate(RATES, read(turned), SIGMA)
    assert found is not None
    assert found[0] == run
    assert np.degrees(found[1]) == pytest.approx(rate, abs=2e-3)


@pytest.mark.parametrize("law", [{}, {"cubic": 0.03}, {"asymmetry": 0.01}])
def test_what_sensors_do_is_no_other_rate(law):
    assert off_rate(RATES, read(RATES, **law), SIGMA) is None
    upwards = np.radians([10.0, 20, 40, 60, 80, 100])  # in one sense only: the last is off its line
    assert off_rate(upwards, read(upwards, **law), SIGMA) is None


def test_two_of_four_runs_may_be_off_so_neither_is():
    few = RATES[:4]
    assert off_rate(few, read(few * [1, 1, 1.03, 1]), SIGMA[:4]) is None


def test_the_turn_by_another_angle_is_told_and_an_asymmetry_is_none():
    scales = 1 + np.array([5e-4, 5e-4, -2e-4, -2e-4, 3e-4, 3e-4])
    assert off_ratio(scales, "xxyyzz") is None
    assert off_ratio(scales * [1, 1, 1, 350 / 360, 1, 1], "xxyyzz") == 3
    assert off_ratio(scales * [1, 1, 1, 350 / 360, 1, 1], "xxzyzz") is None  # or it is the scale
    assert off_ratio(scales + np.array([0, 0, 0.014, -0.014, 0, 0]), "xxyyzz") is None
    assert (
        off_ratio(scales * [1, 1, 1, 1 + 1e-3, 1, 1], "xxyyzz") is None
    )  # criticism weighs so little
