"""How calibrations repeat: components against closed forms, intervals that hold, jumps by date."""

import sys
from copy import deepcopy
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pytest
import test_history as archive
from scipy.spatial.transform import Rotation

from inertial import tables
from inertial.campaign.records import rows_of
from inertial.estimation.history_of_values import History, components, drift, jump, predicted
from inertial.estimation.scatter_and_random_walk import between
from inertial.tables.parquet import write_once
from inertial.tables.yaml_file import YamlFile
from laboratory.folder import campaign_yaml
from stages.history.repeatability import (
    LATEST,
    forecast_rows,
    jumps_of,
    power_cycle_rows,
    repeatability_rows,
    series_of,
)
from stages.plan.certificate import allowed_changes

sys.path.insert(0, str(Path(__file__).parent / "histories"))
import history_draws

# ---- components


def test_in_a_balanced_design_it_is_the_analysis_of_variance():
    """Searle, Casella & McCulloch 1992, 4.8: REML is ANOVA; var MS = 2 MS²/degrees."""
    generator, days, each, own = np.random.default_rng(4), 7, 3, 0.1
    of_day = np.repeat(np.arange(days), each)
    values = 3 * generator.normal(size=days)[of_day] + 2 * generator.normal(size=days * each)
    alike = {"day": [str(d) for d in of_day], "switch_on": [str(i) for i in range(days * each)]}
    found = components(values, np.full(days * each, own), alike).found
    within = values.reshape(days, each).var(axis=1, ddof=1).mean()
    between = each * values.reshape(days, each).mean(axis=1).var(ddof=1)
    day, switch_on = found
    assert day.value == pytest.approx(np.sqrt((between - within) / each), rel=1e-3)
    assert switch_on.value == pytest.approx(np.sqrt(within - own**2), rel=1e-3)
    spread = within * np.sqrt(2 / (days * (each - 1)))
    assert switch_on.sigma == pytest.approx(spread / (2 * switch_on.value), rel=1e-2)
    assert day.upper > day.value


def test_the_known_sigma_is_taken_off_and_an_upper_limit_holds():
    generator, draws, holds = np.random.default_rng(6), 60, 0
    squares = []
    for _ in range(draws):
        sigma = np.exp(0.3 * generator.normal(size=8))
        values = 1.5 * generator.normal(size=8) + sigma * generator.normal(size=8)
        (found,) = components(values, sigma, {"day": [str(i) for i in range(8)]}).found
        squares.append(found.value**2)
        holds += found.upper > 1.5
    assert np.mean(squares) == pytest.approx(1.5**2, rel=0.35)
    assert holds >= 0.85 * draws  # of 95 %


def test_what_the_calibrations_do_not_tell_apart_is_one_component():
    alike = {"day": ["1", "2", "3"], "mounting": ["A", "A", "A"], "switch_on": ["a", "b", "c"]}
    found = components(np.array([0.0, 1.0, 3.0]), np.full(3, 0.1), alike)
    assert [one.names for one in found.found] == [("day", "switch_on")]
    assert found.one == ("mounting",)


# ---- the next calibration


def test_drift_is_weighted_regression():
    times = np.array([0, 0.5, 1.5, 2.0, 4.0])
    sigma = np.array([1, 2, 1, 2, 1.0])
    values = 5 + 30 * times + np.array([0.3, -0.5, 0.2, 0.4, -0.2])
    exact, covariance = np.polyfit(times, values, 1, w=1 / sigma, cov="unscaled")
    found = drift(History(values, sigma, times))
    assert found.rate == pytest.approx(exact[0], rel=1e-9)
    assert found.sigma == pytest.approx(np.sqrt(covariance[0, 0]), rel=1e-6)


def test_intervals_hold_the_next_calibration():
    """A sample of `make histories`, whose 2000 are in docs/repeatability.md: 93 to 97 % of them."""
    holds = [history_draws.outcome("next", number)["holds"] for number in range(120)]
    assert 0.89 <= np.mean(holds) <= 0.99  # 95 % with 2 % of one sigma


def test_an_interval_widens_with_time_and_narrows_with_calibrations():
    generator = np.random.default_rng(2)
    values = 4 * generator.normal(size=12)
    few, many = (History(values[:n], np.ones(n), np.arange(n, dtype=float)) for n in (3, 12))
    ahead = np.array([13.0, 20.0])
    widths = [p.high - p.low for p in (predicted(h, ahead, 1.0) for h in (few, many))]
    assert (widths[0] > 1.5 * widths[1]).all()
    assert widths[1][1] > widths[1][0]
    # Student's interval for the next of twelve, whose days alone differ, and not much wider.
    student = 2 * 2.201 * np.std(values, ddof=1) * np.sqrt(1 + 1 / 12)
    assert 0.8 * student < widths[1][0] < 1.6 * student


def test_a_jump_is_named_with_its_place_and_nothing_else_is():
    outcomes = [history_draws.outcome("jump", number) for number in range(90)]
    none, _small, large = ([o for o in outcomes if o["size"] == s] for s in (0.0, 10.0, 30.0))
    assert not any(one["named"] for one in none)
    assert all(one["right"] for one in large if one["named"])
    assert np.mean([one["right"] for one in large]) > 0.75


def test_the_size_of_a_jump_is_that_of_regression_on_its_step():
    """Where the sigmas alone explain all else: by weighted least squares, its place by the fit."""
    generator = np.random.default_rng(5)
    times, sigma = np.sort(generator.uniform(0, 9, 11)), np.exp(0.3 * generator.normal(size=11))
    values = 0.5 * times + 0.1 * sigma * generator.normal(size=11) + 40 * (np.arange(11) > 6)
    fits = []
    for before in range(10):
        design = np.column_stack([np.ones(11), times, np.arange(11) > before]) / sigma[:, None]
        estimate, misfit, *_ = np.linalg.lstsq(design, values / sigma)
        fits.append((float(misfit[0]), before, estimate[2], np.linalg.inv(design.T @ design)[2, 2]))
    _misfit, before, size, variance = min(fits)
    found = jump(History(values, sigma, times), generator)
    assert (found.before, found.p_value < 1e-3) == (before, True) == (6, True)
    assert found.size == pytest.approx(size, rel=1e-6)
    assert found.sigma == pytest.approx(np.sqrt(variance), rel=1e-6)


@pytest.mark.parametrize("days", [[1, 1, 1, 1, 1], [1, 1, 1, 2, 2]])
def test_of_one_day_or_two_no_jump_is_told_from_a_drift(days):
    values = np.array([0.0, 0.3, -0.2, 9.0, 9.1])
    assert jump(History(values, np.ones(5), np.array(days) / 365), np.random.default_rng(1)) is None


def test_of_very_many_calibrations_the_latest_count():
    """One in the past that is far off moves neither the next nor a jump."""
    generator = np.random.default_rng(3)
    rows = [
        (
            {"date": f"{2000 + n // 12}-{n % 12 + 1:02}-01", "campaign": f"c{n:03}"},
            [
                {"sensor": "gyro", "quantity": "bias_x", "mount": ""}
                | {"value": generator.normal() + 1000 * (n < 30), "sigma": 1.0}
            ],
        )
        for n in range(130)
    ]
    series = series_of(rows)
    assert not jumps_of(series, 0.01)
    (row,) = forecast_rows(series, {}, {})
    assert row["calibrations"] == LATEST < 100
    assert -4 < row["low"] < row["high"] < 4


def test_an_error_that_all_calibrations_share_is_in_no_difference():
    """It moves all values alike, so intervals, drift and jumps are those without it."""
    generator = np.random.default_rng(5)
    values, times, sigma = generator.normal(size=7), np.arange(7.0), np.full(7, 1.0)
    alone = History(values, sigma, times)
    alike = History(values + 400, sigma, times, shared=np.full((7, 1), 1000.0))
    ahead = np.array([7.0, 9.0])
    one, other = (predicted(history, ahead, 1.0) for history in (alone, alike))
    assert other.low == pytest.approx(one.low + 400, abs=1e-3)
    assert other.high == pytest.approx(one.high + 400, abs=1e-3)
    assert drift(alike).rate == pytest.approx(drift(alone).rate, abs=1e-6)
    assert drift(alike).sigma == pytest.approx(drift(alone).sigma, rel=1e-6)
    each = {"day": [str(day) for day in times]}
    found = [components(values, sigma, each, h.shared).found[0] for h in (alone, alike)]
    assert found[1].upper == pytest.approx(found[0].upper, rel=1e-3)


def test_an_error_that_two_of_three_calibrations_share_is_in_the_difference_from_the_third():
    """y₃ − (y₁ + y₂)/2 has the variance 1 + 1/2 and that of both references, 9 + 9."""
    values, shared = np.array([0.0, 0.0, 6.0]), np.array([[3.0, 0], [3, 0], [0, 3]])
    history = History(values, np.ones(3), np.array([0.0, 0.0, 1.0]), shared=shared)
    found = drift(history)
    assert found.rate == pytest.approx(6) and found.sigma == pytest.approx(np.sqrt(19.5))


def test_a_drift_is_no_jump():
    times = np.arange(10.0)
    values = 3 * times + np.random.default_rng(1).normal(size=10)
    found = jump(History(values, np.ones(10), times), np.random.default_rng(2))
    assert found is None or found.p_value > 0.05


# ---- the stage

BIASES = (1.00, 1.03, 0.98, 1.01, 1.60, 1.63, 1.58, 1.61)  # 1e-5 rad/s, known to 1e-7


def calibrated(place, settings, **facts):
    for number, bias in enumerate(BIASES):
        date = f"20{18 + number}-03-02"
        archive.run(
            place, bias * 1e-5, campaign=f"c{number}", date=date, settings=settings, **facts
        )
    folder = place / f"derived/c{len(BIASES) - 1}/history"
    return {
        name: pd.read_parquet(folder / f"{name}.parquet")
        for name in ("repeatability", "jumps", "forecast")
    }


@pytest.mark.slow
def test_a_history_with_a_jump_in_the_archive(tmp_path):
    made = calibrated(tmp_path, {"level": 0.01, "tolerance": {"gyro_bias": 1e-6}}, mounting="A")
    (jumped,) = rows_of(made["jumps"])
    assert (jumped["after"], jumped["until"]) == ("2021-03-02", "2022-03-02")
    assert jumped["size"] == pytest.approx(6e-6, rel=0.1) and jumped["p_value"] < 0.01
    assert "between 2021-03-02 and 2022-03-02" in jumped["sentence"]
    found = made["repeatability"].set_index("component")
    values = 1e-5 * np.array(BIASES)
    assert found.loc["repeatability", "value"] == pytest.approx(np.std(values, ddof=1))
    assert found.loc["within", "value"] == pytest.approx(1e-7)
    assert found.loc["day + switch_on", "value"] == pytest.approx(np.std(values, ddof=1), rel=0.01)
    assert "one mounting" in found.loc["mounting", "reason"]
    (row,) = rows_of(made["forecast"])
    assert row["low"] < 1.6e-5 < row["high"] < 2e-5  # the level after the jump
    assert "2025-03-02" <= row["due"] < "2034" and row["reason"] == ""


def test_without_a_tolerance_nothing_is_due_and_too_few_give_no_interval(tmp_path):
    archive.run(tmp_path, 1e-5, campaign="a", date="2024-03-02")
    archive.run(tmp_path, 2e-5, campaign="b", date="2025-03-02")
    (row,) = rows_of(pd.read_parquet(tmp_path / "derived/b/history/forecast.parquet"))
    assert row["low"] is None and "needs 3" in row["reason"]
    archive.run(tmp_path, 1e-5, campaign="c", date="2026-03-02")
    (row,) = rows_of(pd.read_parquet(tmp_path / "derived/c/history/forecast.parquet"))
    assert row["due"] is None and "config.yaml" in row["reason"]
    assert row["low"] < 1e-5 < row["high"]


def test_the_change_that_a_campaign_allows_counts_before_that_of_the_settings(tmp_path):
    """Half a degree per hour of the campaign file, 2.424e-6 rad/s, not the settings' 1 rad/s."""
    (tmp_path / "campaign.yaml").write_text("may_change: {gyro: {bias_deg_h: 0.5}}")
    (stated,) = allowed_changes(YamlFile(tmp_path / "campaign.yaml"))
    settings = {"level": 0.01, "tolerance": {"gyro_bias": 1.0}}
    for year, bias in enumerate((1.00e-5, 1.05e-5, 0.98e-5)):
        date = f"202{year}-03-02"
        facts = {"campaign": f"c{year}", "date": date, "settings": settings}
        archive.run(tmp_path, bias, may_change=[stated], **facts)
    (row,) = rows_of(pd.read_parquet(tmp_path / "derived/c2/history/forecast.parquet"))
    assert row["tolerance"] == pytest.approx(2.424e-6, rel=1e-3)
    assert row["due"] >= "2022-03-02"


def test_an_archive_of_version_3_is_read(tmp_path):
    old = archive.replace(
        tables.CALIBRATION,
        version=3,
        columns=tuple(
            c for c in tables.CALIBRATION.columns if c.name not in ("mounting", "switch_on")
        ),
    )
    facts = archive.calibration(campaign="spring", date="2026-03-02")
    result = [archive.counted("bias_x", 3e-5, 1e-7)]
    row = facts | {"parameters": result, "content": "", "supersedes": []}
    file = tmp_path / "history/span-cpt/A-017/2026-03-02-spring-0123456789ab.parquet"
    write_once(old, file, [row])
    archive.run(tmp_path, campaign="autumn", date="2026-10-02")
    found = pd.read_parquet(tmp_path / "derived/autumn/history/repeatability.parquet")
    assert found.set_index("component").loc["repeatability", "value"] == pytest.approx(
        2e-5 / np.sqrt(2)
    )


def test_stability_is_the_scatter_of_means_over_ten_seconds():
    generator, count = np.random.default_rng(3), 60
    noise = 1e-5 * generator.normal(size=(count, 6))
    blocks = pd.DataFrame(noise, columns=list(tables.CHANNELS)).assign(
        manoeuvre="z-up", phase="rest", seconds=5.0, count=500.0
    )
    rows = {(row["sensor"], row["quantity"]): row for row in repeatability_rows({}, blocks)}
    row = rows["gyro", "bias_y"]
    expected = noise[:, 4].reshape(30, 2).mean(axis=1).std(ddof=1)
    assert row["value"] == pytest.approx(expected) and row["groups"] == 30


# ---- the simulated laboratory: three calibrations of one IMU


@pytest.mark.slow
def test_the_laboratory_s_history_comes_back(tmp_path):
    """data/simulated/history-*.yaml: gyro biases differ by 2e-6 rad/s, a scale drifts."""
    sources = [chain.ROOT / f"data/simulated/history-{number}.yaml" for number in (1, 2, 3)]
    documents = [chain.laboratory.read(source).document for source in sources]
    for number, document in enumerate(documents, 1):
        raw = chain.simulate(document, tmp_path / f"raw/history-{number}")
        chain.run(raw, tmp_path / f"derived/history-{number}", "history")
    made = chain.Results(tmp_path / "derived/history-3")
    found = made["history/repeatability"]
    found = found[found["sensor"] == "gyro"].set_index(["quantity", "component"])
    for axis, name in enumerate("xyz"):
        hidden = [document["truth"]["gyro"]["bias_rad_s"][axis] for document in documents]
        row = found.loc[(f"bias_{name}", "repeatability")]
        assert row["value"] == pytest.approx(np.std(hidden, ddof=1), rel=0.25)
    # The first two share a mounting; each has a day and a switch-on of its own.
    assert ("bias_x", "day + switch_on") in found.index and ("bias_x", "mounting") in found.index
    assert made["history/jumps"].empty
    forecast = made["history/forecast"].set_index(["sensor", "quantity"])
    scale = forecast.loc["gyro", "scale_z"]
    assert abs(scale["drift"] - 1e-4) < 4 * scale["drift_sigma"]
    assert scale["drift_sigma"] < 4e-5
    assert scale["low"] < 7.942e-4 < scale["high"]  # 100 ppm a year later on
    assert scale["at"] == "2026-09-30"  # after 182 days, as the ones before
    # Their gravity is one: its 50 ppm are in no difference of the scale factors over time.
    accel = forecast.loc["accel"].loc[["scale_x", "scale_y", "scale_z"]]
    assert (accel["high"] - accel["low"] < 4e-5).all() and (accel["drift_sigma"] < 1.5e-5).all()
    truth = np.diag(documents[-1]["truth"]["accelerometer"]["matrix"]) - 1
    sigma = made.parameters("accelerometer").loc[accel.index, "sigma"].to_numpy()
    assert (sigma > 4e-5).all()
    assert (np.abs(accel["median"].to_numpy() - truth) < 4 * sigma).all()


# ---- power cycles within a campaign


def test_between_switch_ons_it_is_the_analysis_of_variance():
    """Nine biases of equal weight about their mean: τ² = s² − σ², var τ² = 2 s⁴/8."""
    values, sigma = np.array([3.0, -1, 4, 1, -5, 9, -2, -6, 5]), 0.5
    centred = (np.eye(9) - 1 / 9) / sigma**2
    tau, error, upper = between(centred, centred @ values)
    square = values.var(ddof=1)
    assert tau == pytest.approx(np.sqrt(square - sigma**2), rel=1e-4)
    assert error == pytest.approx(square * np.sqrt(2 / 8) / (2 * tau), rel=1e-4)
    assert upper > tau + error
    nothing = between(centred, centred @ (0.3 * values / values.std()))
    assert nothing[0] == 0 and np.isnan(nothing[1]) and nothing[2] > 0


@pytest.mark.slow
def test_power_cycles_of_the_laboratory_come_back():
    """Eight switch-ons, biases of 4 °/h and 100 µg: 21 degrees of freedom for each sensor."""
    document = chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    made = chain.in_memory_of(document)
    hidden = {"gyroscope": np.radians(4) / 3600, "accelerometer": 100e-6 * 9.80665}
    for stage, size in hidden.items():
        fit = made[f"{stage}/fit"].set_index("method").loc["joint"]
        found, sigma, upper = (
            np.array([fit[f"switch_on_{axis}{of}"] for axis in "xyz"], np.float64)
            for of in ("", "_sigma", "_upper")
        )
        assert fit["switch_ons"] == 8 and fit["scatter"] == 0
        assert 0.5 < np.sqrt(np.mean(found**2)) / size < 1.5  # 99.9 % of χ² / 21
        assert sigma == pytest.approx(found / np.sqrt(2 * 7), rel=0.1)  # the noise is small
        assert (np.abs(found - size) < 4 * sigma).all() and (upper > found).all()
    matrix = np.array(document["truth"]["gyro"]["matrix"])
    parameters = made.parameters("gyroscope")
    for i, axis in enumerate("xyz"):
        scale, bias = parameters.loc[f"scale_{axis}"], parameters.loc[f"bias_{axis}"]
        assert scale["value"] == pytest.approx(matrix[i, i] - 1, abs=4 * scale["sigma"])
        assert scale["sigma"] < 5e-6  # the turns of a pair share a switch-on
        true = document["truth"]["gyro"]["bias_rad_s"][i]
        assert bias["value"] == pytest.approx(true, abs=4 * bias["sigma"])


@pytest.mark.slow
def test_power_cycles_are_simulated_and_are_no_finding():
    document = chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    made = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    assert made["diagnosis/causes"].empty
    assert set(made["diagnosis/verdict"]["verdict"]) == {"usable"}
    fidelity = made["simulation/fidelity"]
    assert len(fidelity) == (10 + 3 * 6) * 6  # rests; of a turn that before, itself, that after
    rests = fidelity[(fidelity["profile"] == "at rest") & (fidelity["samples"] >= 6)]
    ratio = rests["residual_rms"] / rests["noise_rms"]
    assert 0.8 < np.sqrt(np.mean(ratio**2)) < 1.2  # 60 means of six: 1 with 4 % of one sigma
    # Biases after switch-ons differ by more than ten times what a minute of noise leaves open.
    own = made["gyroscope/switch_ons"].pivot(index="switch_on", columns="axis", values="value")
    assert len(own) == 8 and own.abs().to_numpy().max() > 10 * np.radians(0.012) / 60 / np.sqrt(60)


@pytest.mark.slow
def test_runs_are_not_usable_until_it_is_stated_that_the_biases_are_others(tmp_path):
    """Three logs of one clock each. Then 30 mg are no tilt, of which 1 − cos would be 400 ppm."""
    document = deepcopy(
        chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    )
    document["start"]["pause_s"] = 86_400.0
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up", "rate_hz": 100}
    document["handling"]["change_s"] = 10
    document["campaign"]["site"] |= {"gravity_m_s2": 9.8088, "gravity_sigma_m_s2": 1e-5}
    document["effects"]["turn_on_bias"] = {"gyro_deg_h": 40, "accelerometer_micro_g": 30_000}
    plan = document["campaign"]["plan"]
    for each in plan:
        each.pop("power_cycle", None)
    plan[12:] = [each | {"id": f"{each['id']}-{run}"} for run in (2, 3) for each in plan[:6]]
    for number, each in enumerate(plan):
        each["log"] = f"run-{max(1, number // 6)}.csv"
    for first in (12, 18):
        plan[first]["power_cycle"] = True
    raw = chain.simulate(document, tmp_path / "raw")
    stated = chain.run(raw, tmp_path / "stated", "diagnosis", chain.BESIDE)
    assert set(stated["diagnosis/verdict"]["verdict"]) == {"usable"}
    result = stated["diagnosis/result"].set_index(["sensor", "parameter"]).loc["accel"]
    for i, axis in enumerate("xyz"):
        scale = result.loc[f"scale_{axis}"]
        true = document["truth"]["accelerometer"]["matrix"][i][i] - 1
        assert scale["value"] == pytest.approx(true, abs=4 * scale["sigma"])
        assert scale["sigma"] < 2e-5
    path = raw / "campaign.yaml"
    path.write_text(path.read_text().replace("power_cycle: true", "power_cycle: false"))
    tables = chain.run(raw, tmp_path / "left_out", "diagnosis", chain.BESIDE)
    causes = tables["diagnosis/causes"].set_index("cause")
    assert {"gyro_bias_per_log", "accel_bias_per_log"} <= set(causes.index)
    assert causes.loc["accel_bias_per_log", "action"].startswith("If the IMU was switched off")
    assert set(tables["diagnosis/verdict"]["verdict"]) == {"not_usable"}


def test_leans_of_positions_by_hand_are_no_part_of_what_biases_of_runs_differ_by(tmp_path):
    """Faces lean by 1.5°, which is 26 mg of a level axis; z warms up by 8 mg, which |f| shows."""
    random = np.random.default_rng(31)
    raw = tmp_path / "raw"
    raw.mkdir()
    plan = []
    faces = ["+x", "-x", "+y", "-y", "-z", "+z", *["+z"] * 3]
    for number, face in enumerate(faces):
        up = np.eye(3)["xyz".index(face[1])] * (1 if face[0] == "+" else -1)
        leaning = Rotation.from_rotvec(np.radians(random.normal(0, 1.5, 3))).apply(up)
        warm = 0.0 if number < 6 else -0.008
        force = 9.81 * (leaning + np.array([0.03, 0.004, -0.03 + warm]))
        readings = force + random.normal(0, 0.03, (1000, 3))
        np.savetxt(raw / f"{number}.csv", readings, delimiter=",", fmt="%.5f")
        plan.append({"id": f"{number}", "do": "rest", "up": face, "seconds": 10})
        plan[-1]["log"] = f"{number}.csv"
    form = {"kind": "columns", "delimiter": ",", "header_lines": 0, "time": {"rate_hz": 100}}
    form["accelerometer"] = {"columns": [1, 2, 3], "unit": "m/s2"}
    document = {
        "campaign": 1,
        "instrument": {"name": "faces", "rate_hz": 100, "format": form},
        "serial": "unknown",
        "date": "unknown",
        "site": {"latitude_deg": None, "gravity_m_s2": 9.81, "gravity_sigma_m_s2": 0.001},
        "table": {"name": "by hand", "position_sigma_arcsec": 5400},
        "plan": plan,
    }
    (raw / "campaign.yaml").write_bytes(campaign_yaml(document))
    tables = chain.run(raw, tmp_path / "derived", "criticism", chain.BESIDE)
    findings = tables["criticism/findings"].set_index("cause")
    difference = findings.loc["accel_bias_per_log", "size"]
    assert difference == pytest.approx(0.008 * 9.81, abs=0.004 * 9.81)  # 1 − cos 3°: 1.4 mg


@pytest.mark.slow
def test_beside_power_cycles_an_effect_is_found_and_they_are_estimated_beside_it():
    document = deepcopy(
        chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    )
    document["effects"]["gyro_g_sensitivity"] = {
        "matrix_deg_h_g": [[4.0, 0, 0], [0, -3.0, 0], [0, 0, 4.0]]
    }
    made = chain.in_memory_of(document, "extension", chain.BESIDE)
    (finding,) = rows_of(made["criticism/findings"])
    assert finding["cause"] == "gyro_g_sensitivity"
    extended = made["extension/fit"].set_index(["sensor", "method"]).loc[("gyro", "extended")]
    assert extended["switch_ons"] == 8
    size = np.sqrt(np.mean([extended[f"switch_on_{axis}"] ** 2 for axis in "xyz"]))
    assert 0.5 < size / (np.radians(4) / 3600) < 1.5


@pytest.mark.slow
def test_a_warm_up_begins_anew_after_each_stated_switch_on():
    """The demo's plan, switched off and on twice: 25 and −15 °/h that settle with 150 s."""
    hidden = {"gyro_warm_up": {"start_deg_h": [25, -15, 0], "time_constant_s": 150}}
    document = deepcopy(chain.demo(effects=hidden, seed=77))
    for each in document["campaign"]["plan"]:
        each["power_cycle"] = each["id"] in ("z-up", "y-forward")
    made = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    assert made["diagnosis/causes"]["cause"].tolist() == ["gyro_warm_up"]
    result = made["diagnosis/result"].set_index("parameter")
    for axis, true in zip("xyz", np.radians([25, -15, 0]) / 3600, strict=True):
        found = result.loc[f"gyro_warm_up.b_{axis}"]
        assert found["value"] == pytest.approx(true, abs=4 * found["sigma"])
        assert found["sigma"] < np.radians(0.2) / 3600
    assert result.loc["gyro_warm_up.tau", "value"] == pytest.approx(150, rel=0.05)
    assert result.loc["gyro_warm_up.on_1", "value"] == pytest.approx(4 * 360, abs=0.1)


@pytest.mark.slow
def test_what_rests_on_one_bias_allows_for_that_of_each_switch_on(tmp_path):
    """Checks and navigation have it in their sigmas; figures of the sensors are without it."""
    document = chain.laboratory.read(chain.ROOT / "data/simulated/power-cycles.yaml").document
    raw = chain.simulate(document, tmp_path / "raw/power-cycles")
    made = chain.run(raw, tmp_path / "derived/power-cycles", "navigation", chain.BESIDE)
    checks = made["compensation/checks"].dropna(subset=["in_sigmas_after"])
    off = checks.groupby("quantity")["in_sigmas_after"]
    # 24 deviations of the sensors, each in several checks; Student's sigma is 1.2 of one.
    assert (off.apply(lambda own: np.sqrt(np.mean(own**2))) < 1.6).all()
    figures = made["compensation/characteristics"]
    composite = figures[figures["quantity"] == "composite_error"]
    assert len(composite) == 6 and (composite["value"].abs() < composite["by_noise"]).all()
    drifts = figures[figures["quantity"] == "acceleration_insensitive_drift"].set_index("axis")
    for axis, true in zip("xyz", document["truth"]["gyro"]["bias_rad_s"], strict=True):
        own = made.parameters("gyroscope").loc[f"bias_{axis}"]
        assert drifts.loc[axis, "value"] == pytest.approx(own["value"], abs=own["sigma"] / 4)
        assert drifts.loc[axis, "value"] == pytest.approx(true, abs=4 * own["sigma"])
    errors = made["navigation/navigation_errors"]
    turns = errors[(errors["motion"] == "turn") & (errors["quantity"] == "attitude")]
    assert len(turns) == 6
    assert 0.1 < np.mean((turns["calibrated"] / turns["predicted"]) ** 2) < 2


def test_power_cycles_are_in_the_table_of_repeatability():
    columns = {"switch_on_x": 2e-5, "switch_on_x_sigma": 5e-6, "switch_on_x_upper": 3e-5}
    others = {f"switch_on_{a}{of}": None for a in "yz" for of in ("", "_sigma", "_upper")}
    fit = {"sensor": "gyro", "method": "joint", "switch_ons": 8, **columns, **others}
    (row,) = power_cycle_rows([fit, fit | {"switch_ons": 1}, fit | {"method": "turns"}])
    assert (row["quantity"], row["component"], row["groups"]) == ("bias_x", "power_cycle", 8)
    assert (row["value"], row["upper"], row["unit"]) == (2e-5, 3e-5, "rad/s")


# ---- the real case: snu, one IMU in three sessions by hand


@pytest.mark.slow
def test_the_sessions_of_snu_repeat_within_their_sigmas(drafted):
    """Its SOURCE.md: sessions 2 and 3 agree. Day, mounting and switch-on are one component.

    The first is shorter, and its accelerometers are not usable; what it has agrees, too.
    """
    sessions = []
    for name in ("snu-1", "snu-2", "snu-3"):
        result = rows_of(drafted(name)[1]["diagnosis/result"])
        rows = [
            row | {"quantity": row["parameter"]}
            for row in result
            if row["effect"] is None and row["value"] is not None
        ]
        sessions.append(({"campaign": name, "date": "unknown"}, rows))
    series = series_of(sessions)
    found = pd.DataFrame(repeatability_rows(series, tables.BLOCKS.empty()))
    between = found[found["component"] == "day + mounting + switch_on"]
    within = found[found["component"] == "within"].set_index(["sensor", "quantity"])["value"]
    assert len(between) >= 20
    ratio = between.set_index(["sensor", "quantity"])["value"] / within
    assert ratio.median() < 1.0  # the sessions show no more than their sigmas


def test_where_some_biases_are_known_a_million_times_better_than_others_there_is_a_limit():
    """The search began where the deviance of the best known had risen already, and stopped."""
    information = np.diag([1e12, 1e12, 1.0, 1e-2])
    value, _sigma, upper = between(information, np.zeros(4))
    assert value == 0 and 1e-6 < upper < 1e-5  # of two that are known to 1e-6
