"""Linearity, asymmetry, composite error and drift without force, as the standards define them."""

import chain
import numpy as np
import pandas as pd
import pytest
from scipy import stats

from inertial.effects import CATALOGUE
from inertial.estimation.input_output import (
    Limits,
    asymmetry,
    at_no_force,
    composite_error,
    least_by_counts,
    linearity_error,
    resolution,
    threshold,
)
from stages.compensation.characteristics import (
    OF_FORCE,
    OF_INPUT,
    Point,
    least_changes,
    of_axis,
)

pytestmark = pytest.mark.slow

DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s
PPM = 1e-6


def test_the_error_of_a_parabola_in_three_points_is_largest_in_the_middle():
    """y = x + c x² at −1, 0, 1: its line is x + 2/3 c, and the variance of a residual there 2/3."""
    applied = np.array([-1.0, 0.0, 1.0])
    found = linearity_error(applied, applied + 0.06 * applied**2 + 3.0, np.full(3, 1e-6))
    assert found.value == pytest.approx(-0.04)
    assert found.sigma == pytest.approx(1e-6 * np.sqrt(2 / 3))


def test_what_figures_describe_is_in_the_catalogue():
    assert set(CATALOGUE) >= OF_INPUT | OF_FORCE


def test_two_inputs_have_no_linearity_error():
    applied = np.array([-1.0, 1.0, 1.0])
    assert linearity_error(applied, applied, np.ones(3)) is None
    assert asymmetry(applied, applied, np.ones(3)) is None


def test_noise_alone_exceeds_its_limit_in_one_case_of_twenty():
    random = np.random.default_rng(1)
    sigma = np.array([1.0, 3.0, 2.0, 0.5])
    applied = np.array([-4.0, -1.0, 1.0, 4.0])
    errors = [
        composite_error(applied, applied + sigma * noise, sigma)
        for noise in random.normal(size=(4000, 4))
    ]
    beyond = sum(abs(one.value) > one.by_noise for one in errors)
    assert stats.binomtest(beyond, len(errors), 0.05).pvalue > 1e-3


def test_what_force_adds_is_no_drift_without_force():
    random = np.random.default_rng(2)
    force = 9.8 * np.vstack([np.eye(3), -np.eye(3)])
    rate = 3e-6 + force @ [1e-7, -2e-7, 5e-7] + 1e-9 * random.normal(size=6)
    drift, sigma = at_no_force(rate, np.full(6, 1e-9), force)
    assert sigma == pytest.approx(1e-9 / np.sqrt(6))
    assert drift == pytest.approx(3e-6, abs=4 * sigma)
    assert at_no_force(rate[:1], np.full(1, 1e-9), force[:1]) is None


def test_inputs_in_the_dead_band_are_below_the_threshold():
    """A band of ±2 swallows ±1 whole; the other outputs are as large as their inputs."""
    applied = np.array([-3.0, -1.0, 1.0, 3.0, 50.0, 54.0])
    read = np.where(np.abs(applied) < 2, 0.0, applied)
    sigma = np.full(6, 0.1)
    assert threshold(applied, read, sigma) == Limits(1.0, 3.0)
    assert resolution(applied, read, sigma) == Limits(None, 4.0)
    assert threshold(applied, applied, sigma) == Limits(None, 1.0)
    assert resolution(applied[:4], read[:4], sigma[:4]).upper is None
    assert threshold(applied[:4], applied[:4], np.full(4, 2.0)) == Limits(None, None)


def test_a_change_that_is_lost_is_below_the_resolution():
    """From 50 to 51 nothing happens, from 50 to 54 all of it."""
    found = resolution(
        np.array([1.0, 50.0, 51.0, 54.0]), np.array([1.0, 50.0, 50.0, 54.0]), np.full(4, 0.1)
    )
    assert found == Limits(1.0, 3.0)


def test_a_turn_with_longer_rests_in_it_is_no_other_input():
    """Twice 30 °/s, by chance recorded with other rests: the means of 26.3 and 26.5 say nothing."""
    applied, sigma = np.array([0.003, 26.3, 26.5, 28.0]), np.full(4, 1e-3)
    stated = np.array([0.003, 30.0, 30.0, 32.0])
    assert resolution(applied, applied, sigma, stated) == Limits(None, 1.5)
    assert resolution(applied, applied, sigma).upper == pytest.approx(0.2)


def test_an_input_that_is_sensed_here_and_lost_there_limits_no_threshold():
    """Twice 11 °/h up: once read as such, once as −10 °/h, by a hysteresis of the bias."""
    points = [Point(1, *each, each[0]) for each in [(11, 11, 11, 0.5), (11, -10, -10, 0.5)]]
    points.append(Point(1, 1e6, 1e6, 1e6, 0.5, 1e6))
    rows = {row["quantity"]: row for row in of_axis("gyro", 1, points, "", "", None)}
    assert rows["threshold"]["value"] is None
    assert rows["threshold"]["lower"] is None
    assert "sensed in one place and lost in another" in rows["threshold"]["reason"]


@pytest.mark.parametrize(("noise", "least"), [(0.0, 1.0), (0.3, 0.0)])
def test_counts_swallow_a_change_of_one_where_no_noise_dithers_them(noise, least):
    assert least_by_counts(noise) == pytest.approx(least, abs=0.03)


@pytest.mark.parametrize("noise", [0.05, 0.15, 0.2, 0.25])
def test_the_mean_of_rounded_readings_is_less_than_half_below_that(noise):
    """By a million rounded readings each, from the middle of a count, where most is lost."""
    least = least_by_counts(noise)
    random = np.random.default_rng(5)

    def mean(at):
        return np.rint(at + noise * random.standard_normal(1_000_000)).mean()

    assert mean(least / 2 - 0.01) - mean(0.01 - least / 2) < 0.5 * least
    assert mean(least / 2 + 0.03) - mean(-least / 2 - 0.03) > 0.5 * (least + 0.06)


def test_noise_alone_is_sensed_in_one_case_of_twenty():
    """All outputs are half of their input, the edge of what counts as sensed."""
    random = np.random.default_rng(3)
    applied, sigma = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.3, 0.2])
    noise = sigma * random.normal(size=(4000, 3))
    sensed = sum(threshold(applied, applied / 2 + one, sigma).upper is not None for one in noise)
    assert stats.binomtest(sensed, len(noise), 0.05).pvalue > 1e-3


@pytest.fixture(scope="module")
def compensation(tmp_path_factory):
    """Gyros and accelerometers with a share of |input| in their output, S0's six positions."""
    folder = tmp_path_factory.mktemp("asymmetric")
    effects = {
        "gyro_scale_asymmetry": {"asymmetry_ppm": [150, -400, 250]},
        "accel_scale_asymmetry": {"asymmetry_micro_g_g": [200, -300, 0]},
    }
    chain.simulate(chain.short(effects=effects), folder / "raw")
    return chain.run(folder / "raw", folder / "derived", "compensation")


@pytest.fixture(scope="module")
def asymmetric(compensation):
    rows = compensation["compensation/characteristics"]
    return rows.set_index(["sensor", "quantity", "axis"]).sort_index()


@pytest.mark.parametrize(
    ("sensor", "half_ppm"), [("gyro", [150, -400, 250]), ("accel", [200, -300, 0])]
)
def test_asymmetry_is_the_difference_of_the_scale_factors_of_both_ways(
    asymmetric, sensor, half_ppm
):
    found = asymmetric.loc[sensor, "asymmetry"]
    pulls = (found["value"] - 2 * PPM * np.array(half_ppm)) / found["sigma"]
    assert np.abs(pulls).max() < 4
    assert found["sigma"].max() < 50 * PPM


def test_a_linearity_error_beyond_noise_is_that_of_the_asymmetry(asymmetric):
    """The y axis is up in one rest and before and after two turns, down in one, else level."""
    row = asymmetric.loc["accel", "linearity_error", "y"]
    applied = np.array([1.0] * 5 + [-1.0] + [0.0] * 12)
    bent = np.abs(applied)
    off_line = bent - np.polyval(np.polyfit(applied, bent, 1), applied)
    expected = 300 * PPM * np.abs(off_line).max()
    assert abs(row["value"]) == pytest.approx(expected, abs=4 * row["sigma"])
    assert abs(row["value"]) > 4 * row["by_noise"]
    assert row["points"] == 18
    assert row["largest_input"] == pytest.approx(9.7936174)


def test_gyros_on_a_table_at_rest_are_shown_to_feel_the_earth(asymmetric):
    """Each axis is up and down once; S0's Ω sin φ is 7.64 °/h. All turns are at one rate."""
    limits = asymmetric.loc["gyro", "threshold"]
    np.testing.assert_allclose(limits["value"] / DEGREE_PER_HOUR, 7.64, atol=0.01)
    assert limits["sigma"].isna().all()
    assert asymmetric.loc["gyro", "resolution"]["value"].isna().all()


def test_gravity_alone_is_no_upper_limit_of_the_threshold_of_an_accelerometer(asymmetric):
    """Each axis reads ±g or lies level: that g is sensed says nothing of a threshold."""
    limits = asymmetric.loc["accel", "threshold"]
    assert limits["value"].isna().all()
    assert set(limits["reason"]) == {"no small input along the axis was applied"}


def test_the_drift_without_force_is_the_bias(coupled):
    """G is 14, −10 and 12 °/h/g in this campaign; S0's biases are hidden in it."""
    found = coupled["compensation/characteristics"]
    drift = found[found["quantity"] == "acceleration_insensitive_drift"]
    pulls = (drift["value"].to_numpy() - [1.30e-06, -2.10e-06, 0.90e-06]) / drift["sigma"]
    assert np.abs(pulls).max() < 4
    assert drift["sigma"].max() < 2 * DEGREE_PER_HOUR


def test_the_result_leaves_noise(coupled):
    """Without G in the result the gyros would be off by 10 °/h of 60 °/s, 46 ppm."""
    found = coupled["compensation/characteristics"].query("quantity == 'composite_error'")
    assert (found["value"].abs() < 1.5 * found["by_noise"]).all()
    assert found.query("sensor == 'gyro'")["by_noise"].max() < 30 * PPM


def test_the_budget_adds_up_and_has_gravity_and_the_angle_of_the_table(compensation):
    """Scale factors: σ_g/g, 5.1 ppm; two turns of 2″ in 360°, 2/(1296000 √2), 1.09 ppm."""
    rows = compensation["compensation/uncertainty_budget"]
    sums = rows.groupby(["sensor", "quantity"])["share"].sum()
    np.testing.assert_allclose(sums, 1, atol=2e-3)
    own = rows.set_index(["sensor", "quantity", "source"])["sigma"]
    assert own["accel", "scale_x", "gravity"] == pytest.approx(5e-5 / 9.7936174, rel=0.01)
    assert own["gyro", "scale_x", "angle"] == pytest.approx(2 / 1_296_000 / np.sqrt(2), rel=0.02)
    assert own["accel", "cross_xy", "position"] == pytest.approx(
        np.radians(2 / 3600) / np.sqrt(2), rel=0.3
    )


def test_counts_that_are_coarser_than_the_noise_limit_the_resolution():
    """Gyros in whole counts of 30 °/h without carry, noise 0.02: a change of one is needed."""
    statistics = pd.DataFrame(
        {"log": "a", "sensor": ["gyro", "accel"], "axis": "x", "resolution": 30.0, "noise": 0.0}
    )
    ranges = statistics[["log", "sensor", "axis"]].assign(increments=[False, True])
    levels = pd.DataFrame({"phase": "rest", "channel": ["gyro_x"], "per_sample": [0.6]})
    limit = least_changes(statistics, ranges, levels)
    assert limit == {("gyro", "x"): pytest.approx(30, rel=0.05)}
    dithered = least_changes(statistics, ranges, levels.assign(per_sample=15.0))
    assert dithered == {}
