"""What one table does to all gyros alike: the same IMU on another table shows it."""

import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from inertial.model_selection.common_scale import Comparison, ScaleFactors, comparisons
from inertial.model_selection.fleet_search import smallest_of
from inertial.model_selection.outlying_changes import without_outlying
from overviews.fleet.members import PARAMETERS, Member, References, scale_factors_of
from overviews.fleet.page import fleet_page
from overviews.fleet.results import results_of

SIGMA = 26e-6  # of a scale factor, of two turns there and back at a rate known to 50 ppm
SHARE = 3e-4  # chance of a single hypothesis that a search for some hundred accepts
OFF = 200e-6  # of the rate of the last table
BOTH = {"false_discoveries": 0.03, "outliers": 0.01}


def scale_factors(imus, tables, seed, *, turn_on=0.0, common=0.0, off=(0.0, OFF), sigma=SIGMA):
    """Each IMU once on each of so many tables. `off`: of each, along all axes, or (3,)."""
    random = np.random.default_rng(seed)
    own = 2e-3 * random.normal(size=(imus, 3))
    rows = [(i, t) for t in range(tables) for i in range(imus)]
    values = np.array([own[i] + np.broadcast_to(off[t], 3) for i, t in rows])
    values += sigma * random.normal(size=values.shape) + turn_on * random.normal(size=values.shape)
    values += common * random.normal(size=(len(rows), 1))
    covariance = np.tile(sigma**2 * np.eye(3), (len(rows), 1, 1))
    names = tuple(f"imu {i}" for i, _ in rows), tuple(f"table {t}" for _, t in rows)
    return ScaleFactors(values, covariance, *names, tuple(f"{i} on {t}" for i, t in rows))


def found(*args, **more):
    (compared,) = comparisons(scale_factors(*args, **more))
    return compared.found(SHARE, 0)


# ---- The difference and its chance, by other ways.


def test_the_chance_is_that_of_paired_differences_where_only_turn_ons_scatter():
    """Nine differences of nine scale factors: Student's t of eight degrees."""
    of = scale_factors(3, 2, 1, turn_on=100e-6, off=(0.0, 120e-6), sigma=1e-9)
    pairs = (of.values[3:] - of.values[:3]).ravel()
    expected = stats.ttest_1samp(pairs, 0.0)
    one = Comparison(of).difference(0)
    assert (one.more, one.less) == (("table 1",), ("table 0",))
    assert one.value == pytest.approx(pairs.mean(), rel=1e-6)
    assert one.chance == pytest.approx(expected.pvalue, rel=0.05)
    width = stats.t.isf(0.3173 / 2, 8) * pairs.std(ddof=1) / 3
    assert one.sigma == pytest.approx(width, rel=0.03)
    of_imus = (of.values[3:] - of.values[:3]).mean(axis=1)
    assert one.common_chance == pytest.approx(stats.ttest_1samp(of_imus, 0.0).pvalue, abs=0.3)


def test_an_axis_that_is_not_known_and_correlations_are_as_in_least_squares_of_all():
    random = np.random.default_rng(2)
    of = scale_factors(4, 3, 3, off=(0.0, 0.0, 90e-6))
    root = SIGMA * random.normal(size=(12, 3, 3))
    covariance = root @ root.transpose(0, 2, 1) + SIGMA**2 * np.eye(3)
    values = of.values.copy()
    values[5, 1] = values[8, 2] = np.nan
    compared = Comparison(ScaleFactors(values, covariance, of.imus, of.tables, of.campaigns))
    shown = np.flatnonzero(np.isfinite(values).ravel())
    design = np.zeros((36, 13))
    for row in range(12):
        design[3 * row : 3 * row + 3, 3 * (row % 4) : 3 * (row % 4) + 3] = np.eye(3)
        design[3 * row : 3 * row + 3, 12] = of.tables[row] == "table 2"
    whole = np.zeros((36, 36))
    for row in range(12):
        whole[3 * row : 3 * row + 3, 3 * row : 3 * row + 3] = covariance[row]
    weight = np.linalg.inv(whole[np.ix_(shown, shown)])
    kept = design[shown]
    normal = np.linalg.inv(kept.T @ weight @ kept)
    expected = (normal @ kept.T @ weight @ values.ravel()[shown])[-1]
    sums = compared.sums(0.0)
    assert sums.right[2] / sums.information[2, 2] == pytest.approx(expected, rel=1e-6)
    assert sums.information[2, 2] == pytest.approx(1 / normal[-1, -1], rel=1e-6)


def test_the_smallest_of_independent_chances():
    assert smallest_of(2, 0.19) == pytest.approx(0.1)  # 1 − 0.9²


# ---- What is said of which fleet.


def test_a_table_that_all_axes_of_all_imus_show_is_named_with_its_size():
    sizes = [found(3, 2, seed) for seed in range(20)]
    assert all(len(own) == 1 for own in sizes)
    errors = [(own[0].value - OFF) / own[0].sigma for own in sizes]
    assert abs(np.mean(errors)) < 3 / np.sqrt(20) and np.std(errors) < 1.5
    # Of nine differences of two sigmas each.
    assert np.median([own[0].sigma for own in sizes]) == pytest.approx(SIGMA * np.sqrt(2 / 9), 0.2)


def test_one_of_three_tables_is_named_against_the_others():
    (one,) = found(4, 3, 5, off=(0.0, -OFF, 0.0))
    assert (one.more, one.less) == (("table 0", "table 2"), ("table 1",))
    assert one.value == pytest.approx(OFF, abs=4 * one.sigma)
    assert one.possible == ("table",) and one.imus == 4


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"turn_on": 40e-6},
        {"turn_on": 400e-6},
        {"off": (0.0, np.array([0.0, 0.0, 300e-6]))},  # one axis is no error of the table
    ],
)
def test_nothing_is_said_where_axes_change_each_by_itself(change):
    assert not [s for s in range(20) if found(3, 2, s, **({"off": (0.0, 0.0)} | change))]


def test_what_all_axes_of_an_imu_change_by_is_not_laid_on_the_table_alone():
    named = [found(3, 2, seed, common=150e-6, off=(0.0, 0.0)) for seed in range(25)]
    assert sum(bool(own) for own in named) <= 3
    assert not any(own[0].possible == ("table",) for own in named if own)


def test_one_imu_once_on_each_table_tells_nothing_apart():
    (one,) = found(1, 2, 7, off=(0.0, 5e-3))
    assert one.possible == ("table", "campaign") and np.isnan(one.common_chance)


def test_tables_without_a_common_imu_are_not_compared():
    of = scale_factors(2, 2, 8)
    apart = ScaleFactors(of.values, of.covariance, tuple("abcd"), of.tables, of.campaigns)
    assert not list(comparisons(apart))


# ---- One calibration that drifted.

DRIFT = 400e-6  # of one axis


def drifted(imus, tables, seed, *, rows=(0,), axes=(2,), later=False, **more):
    """One or more scale factors that are off; `later`: of a further campaign of the last IMU."""
    of = scale_factors(imus, tables, seed, **more)
    values, covariance = of.values, of.covariance
    if later:
        values = np.vstack([values, values[imus - 1] + SIGMA * np.sqrt(2) * np.array([1, -1, 0.5])])
        covariance = np.concatenate([covariance, covariance[:1]])
        labels = (own + own[imus - 1 : imus] for own in (of.imus, of.tables))
        of = ScaleFactors(values, covariance, *labels, (*of.campaigns, "late"))
        rows = (len(values) - 1,)
    values[np.ix_(rows, axes)] += DRIFT
    return of


def kept_of(of, level=0.01):
    (compared,) = comparisons(of)
    return without_outlying(compared, level)


def test_the_drop_without_a_value_is_that_of_a_comparison_without_it():
    of = scale_factors(4, 3, 3, off=(0.0, 0.0, 90e-6))
    of.values[5, 1] = np.nan
    compared = Comparison(of)
    turn_on = (30e-6) ** 2
    found = compared.residuals(turn_on, compared.sums(turn_on))
    for row, axis in ((0, 0), (7, 2), (10, 1)):
        less = Comparison(of.without(row, axis))
        left = less.residuals(turn_on, less.sums(turn_on))
        assert found.square - found.drops[row, axis] == pytest.approx(left.square, rel=1e-6)
    assert compared.residuals(turn_on, compared.sums(turn_on)).square > 1


@pytest.mark.parametrize("how", [{"later": True}, {"axes": (0, 2)}])
def test_a_table_is_found_beside_one_calibration_that_drifted(how):
    """Two drifted axes hide each other from a test of one at a time."""
    found_alone, sizes = 0, []
    for seed in range(10):
        of = drifted(3, 2, seed, **how)
        found_alone += bool(next(comparisons(of)).found(SHARE, 0))
        compared, outlying = kept_of(of)
        (one,) = compared.found(SHARE, 0)
        sizes.append((one.value - OFF) / one.sigma)
        assert {each.axis for each in outlying} == set(how.get("axes", (2,)))
        assert all(abs(each.size) == pytest.approx(DRIFT, abs=5 * each.sigma) for each in outlying)
        assert all(each.campaign == "late" or not how.get("later") for each in outlying)
        assert all(len(each.others) == 1 + bool(how.get("later")) for each in outlying)
    assert not found_alone
    assert abs(np.mean(sizes)) < 3 / np.sqrt(10)


def test_of_three_campaigns_the_one_that_is_off_is_named():
    of = drifted(4, 3, 3, rows=(5,), axes=(1,), off=(0.0, 0.0, OFF))
    _, (one,) = kept_of(of)
    assert (one.imu, one.campaign, one.axis) == ("imu 1", "1 on 1", 1)
    assert set(one.others) == {"1 on 0", "1 on 2"}
    assert one.size == pytest.approx(DRIFT, abs=4 * one.sigma)


@pytest.mark.slow
@pytest.mark.parametrize("shape", [(2, 2), (3, 2), (4, 3)])
@pytest.mark.parametrize("turn_on", [0.0, 400e-6])
def test_changes_of_one_law_have_outliers_as_rarely_as_wanted(shape, turn_on):
    """And tables are found as rarely as wanted, though outliers are left out before."""
    count, level = 100, 0.05
    outliers = differences = 0
    for seed in range(count):
        compared, outlying = kept_of(scale_factors(*shape, seed, turn_on=turn_on, off=[0.0] * 3))
        outliers += bool(outlying)
        differences += bool(compared.found(level, 0))
    assert outliers <= stats.binom.isf(1e-3, count, 0.01)
    assert differences <= stats.binom.isf(1e-3, count, level)


@pytest.mark.parametrize(
    "change",
    [
        {"off": (0.0, np.array([0.0, 0.0, 300e-6]))},
        {"off": (0.0, np.array([0.0, 300e-6, 300e-6]))},
    ],
)
def test_what_some_axes_of_all_imus_change_by_is_no_outlier(change):
    for seed in range(10):
        compared, outlying = kept_of(scale_factors(3, 2, seed, **change))
        assert not outlying and not compared.found(SHARE, 0)


# ---- From campaigns to the page.


def members(sensor="gyro", turns="steady", named=True):
    """Three IMUs on two tables; 3° between the mountings, of which lengths of rows know nothing."""
    of = scale_factors(3, 2, 9, off=(0.0, OFF))
    steady = (sensor, turns) == ("gyro", "steady")
    of_scales = [kind == "gyro" and name.startswith("scale") for kind, name in PARAMETERS]
    by_table = 50e-6 * np.array(of_scales) * steady
    for number, (diagonal, imu, table) in enumerate(
        zip(of.values, of.imus, of.tables, strict=True)
    ):
        angle = np.radians(3.0) * (number > 2)
        turned = [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
        matrix = np.diag(1 + diagonal) @ np.array(turned) - np.eye(3)
        values = np.full(24, np.nan)
        first = PARAMETERS.index((sensor, "scale_x"))
        values[first : first + 9] = matrix.ravel()
        yield Member(
            campaign=f"c-{number}",
            mount="",
            type="type",
            imu=imu,
            table=table,
            simulated=False,
            logs=frozenset({str(number)}),
            score={},
            units={},
            information=pd.DataFrame(),
            values=values,
            covariance=SIGMA**2 * np.eye(24) + np.outer(by_table, by_table),
            gravity=(9.8, 1e-6),
            by_table=by_table,
            references=References(named, frozenset({turns}), {"rate": 50e-6}),
        )


def test_lengths_of_rows_know_neither_the_mounting_nor_the_error_of_all_rates_of_a_table():
    own = scale_factors_of(list(members()), "gyro")
    expected = scale_factors(3, 2, 9, off=(0.0, OFF))
    np.testing.assert_allclose(own.values, expected.values, atol=1e-12)
    variances = np.diagonal(own.covariance, axis1=1, axis2=2)
    np.testing.assert_allclose(variances, SIGMA**2, rtol=1e-9)


@pytest.mark.parametrize(
    ("sensor", "turns", "effects", "words"),
    [
        (
            "gyro",
            "steady",
            ["table_speed_error"],
            ("either the rates of table 1 are higher", "or those of table 0 lower"),
        ),
        (
            "gyro",
            "whole",
            ["table_angle_scale"],
            ("either the angles of table 1 are larger", "or those of table 0 smaller"),
        ),
        (
            "accel",
            "whole",
            ["gravity_error", "clock_scale"],
            ("either gravity at table 1 is larger", "or at table 0 smaller"),
        ),
    ],
)
def test_the_page_says_which_tables_differ_and_both_explanations(sensor, turns, effects, words):
    rows, searched = results_of(list(members(sensor, turns)), **BOTH)
    assert searched == 1
    (finding,) = rows["findings"]
    assert finding["level"] == "table" and finding["p_value"] < 1e-3
    assert [row["effect"] for row in rows["members"]] == effects
    (row,) = rows["table_differences"]
    assert (row["more"], row["less"], row["imus"], row["axes"]) == ("table 1", "table 0", 3, 3)
    assert row["value"] == pytest.approx(OFF, abs=4 * row["sigma"])
    stated = 50e-6 * np.sqrt(2) if turns == "steady" else None
    assert row["stated"] == pytest.approx(stated)
    html = fleet_page(rows, searched, 0.03, "test", [], "c0de", simulated=False)
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))
    assert all(own in text for own in words)
    assert "table 1 against table 0" in text and ("leaves 71 ppm" in text) == (turns == "steady")


def test_the_page_names_a_drifted_calibration_and_the_table_error_that_it_hid():
    every = list(members())
    place = PARAMETERS.index(("gyro", "scale_z"))
    later = every[2].values.copy()
    later[place] += DRIFT
    logs = frozenset({"late"})
    rows, _ = results_of(
        [*every, replace(every[2], campaign="late", values=later, logs=logs)], **BOTH
    )
    (row,) = rows["table_differences"]
    assert row["value"] == pytest.approx(OFF, abs=4 * row["sigma"])
    (change,) = rows["outlying_changes"]
    assert (change["imu"], change["axis"], change["campaign"]) == ("imu 2", "z", "late")
    assert change["others"] == "c-2 and c-5"
    html = fleet_page(rows, 1, 0.03, "test", [], "c0de", simulated=False)
    assert "larger in late than in c-2 and c-5" in re.sub(r"\s+", " ", html)


def test_the_page_says_how_much_tables_may_differ_where_none_is_found():
    every = list(members())
    flat = [replace(m, values=m.values - OFF * _scales() * (n > 2)) for n, m in enumerate(every)]
    rows, _ = results_of(flat, **BOTH)
    assert not rows["table_differences"]
    (row,) = rows["tables_alike"]
    assert not row["as_well"] and row["value"] < 4 * row["sigma"]
    html = fleet_page(rows, 1, 0.03, "test", [], "c0de", simulated=False)
    assert "No difference between tables is found in the gyros" in re.sub(r"\s+", " ", html)


def _scales():
    """1 at the scale factors of the gyros."""
    return np.array([kind == "gyro" and name.startswith("scale") for kind, name in PARAMETERS])


def test_tables_without_a_name_are_not_compared():
    rows, searched = results_of(list(members(named=False)), **BOTH)
    assert not searched and not rows["findings"]
