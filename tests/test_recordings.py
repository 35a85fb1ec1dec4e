"""Real recordings through the chain: against what others published, and what the data allow."""

import json
import shutil
import subprocess
import sys
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

from inertial.estimation.triad import linear_names
from stages.report.sections import verdict
from stages.report.stage import report
from stages.report.tables import Tables

NAMES = ("imucal-labelled", "imucal-continuous", "whu", "softdream", "cuyo", "hipnuc")
ARC_HOUR = np.radians(1 / 3600)  # rad/s in °/h


def matrix_of(results: chain.Results, stage: str, column: str) -> tuple[np.ndarray, np.ndarray]:
    """M − I and the bias of the joint fit, or their sigmas."""
    values = results.parameters(stage)[column].reindex(linear_names()).to_numpy(float)
    return values[:9].reshape(3, 3), values[9:]


def read(results: chain.Results) -> dict[str, Any]:
    """What the report reads: the tables, and their provenance."""
    stage = chain.stage_of("report")
    return stage.inputs(stage.paths(results.folder))


def verdict_of(results: chain.Results) -> str:
    tables = read(results)
    provenance = tables.pop("provenance")
    return verdict.as_text(Tables(tables, provenance))


# ---- imucal_ferraris, by hand


def test_imucal_labelled_accelerometer_agrees_with_its_published_calibration(recorded, recordings):
    results = recorded("imucal-labelled")
    published = json.loads((recordings / "imucal_ferraris/example_cal.json").read_text())
    # Theirs: truth = R⁻¹ K⁻¹ (counts − b); ours: reading = counts / 208.9 = M · truth + bias.
    theirs = np.array(published["K_a"]) @ np.array(published["R_a"]) / 208.9 - np.eye(3)
    ours, bias = matrix_of(results, "accelerometer", "value")
    sigma, _ = matrix_of(results, "accelerometer", "sigma")
    assert np.abs((ours - theirs) / sigma).max() < 2.5
    # Their bias is a mean of six readings; 1° of tilt moves four.
    tilt = 9.81 * np.radians(1) * np.sqrt(4) / 6
    assert np.abs(bias - np.array(published["b_a"]) / 208.9).max() < 2 * tilt


def test_imucal_labelled_gyro_agrees_up_to_the_sign_of_the_turn(recorded, recordings):
    results = recorded("imucal-labelled")
    published = json.loads((recordings / "imucal_ferraris/example_cal.json").read_text())
    theirs = -np.array(published["K_g"]) @ np.array(published["R_g"]) / 16.4 - np.eye(3)
    ours, bias = matrix_of(results, "gyroscope", "value")
    sigma, bias_sigma = matrix_of(results, "gyroscope", "sigma")
    assert np.abs((ours - theirs) / sigma).max() < 2
    rates = np.radians(np.array(published["b_g"]) / 16.4)
    assert np.abs((bias - rates) / bias_sigma).max() < 3
    assert results.parameters("gyroscope")["value"].notna().all()  # one direction was enough


def test_imucal_turns_of_one_direction_are_no_pair_for_the_formula(recorded):
    turns = recorded("imucal-labelled").parameters("gyroscope", "turns")
    assert turns["value"].isna().all()
    assert turns["reason"].str.contains("forward and backward").all()


def test_imucal_runs_through_all_of_it_and_nothing_is_named_that_the_data_do_not_hold(recorded):
    """A gyro rest is off by 0.8 °/s, for the hand moves already; its noise is louder by as much."""
    for name in ("imucal-labelled", "imucal-continuous"):
        results = recorded(name)
        assert not results["criticism/scores"]["named"].any()
        assert results["extension/parameters"].empty
        checks = results["compensation/checks"]
        gravity = checks[checks["quantity"].str.contains("gravity")]
        assert (gravity["after"] - gravity["expected"]).abs().max() < 0.1  # m/s²
        assert (gravity["before"] - gravity["expected"]).abs().max() > 0.1
        assert len(results["history/archived"]) == 1
    # Its z accelerometer drifts where it is level, and not where it is upright: the support tilts.
    assert recorded("imucal-labelled")["criticism/findings"].empty
    levels = recorded("imucal-labelled")["noise/levels"].query("source == 'own'")
    assert ("z-turn", "gyro_z") in set(zip(levels["manoeuvre"], levels["channel"], strict=True))
    assert recorded("imucal-continuous")["criticism/findings"].empty


def test_imucal_continuous_finds_every_part(recorded):
    results = recorded("imucal-continuous")
    performed = results["segment/performed"].set_index("manoeuvre")
    assert performed["complete"].all()
    # What its SOURCE.md found by adding up the selected rows.
    angles = np.degrees(performed.loc[["x-turn", "y-turn", "z-turn"], "angle"])
    np.testing.assert_allclose(angles, [-371.9, -354.8, -359.2], atol=2)
    assert results.parameters("accelerometer")["value"].notna().all()


# ---- whu_xwgi7681_excerpt, a third of a second of each manoeuvre on a three-axis table


def test_whu_every_checksum_is_right(recorded):
    accounts = recorded("whu")["decode/accounts"]
    assert accounts.set_index("kind").loc["decoded", "lines"].sum() == 412
    assert set(accounts["kind"]) == {"decoded"}


def test_whu_accelerometer_agrees_with_the_published_result(recorded):
    results = recorded("whu")
    # lidongyang2004, from three minutes of each position; SOURCE.md of the recording.
    scale = np.diag([264.83e-6, 383.55e-6, 445.63e-6])
    cross = np.array(
        [[0, 0.0039051, -0.00799005], [-0.00409682, 0, 0.0004882], [0.0083232, -0.00042507, 0]]
    )
    ours, bias = matrix_of(results, "accelerometer", "value")
    sigma, bias_sigma = matrix_of(results, "accelerometer", "sigma")
    assert np.abs((ours - scale - cross) / sigma).max() < 2
    assert np.abs((bias - [-0.00943451, 0.00142041, -0.01676003]) / bias_sigma).max() < 2


def test_whu_sigmas_are_honest_for_a_third_of_a_second(recorded):
    results = recorded("whu")
    fit = results["accelerometer/fit"].iloc[0]
    # The x axis reads 1.7 mm/s² more when it is vertical than the twelve parameters allow.
    assert fit["p_value"] < 1e-10
    assert 0.5e-3 < fit["scatter"] < 3e-3  # m/s²


def test_whu_every_turn_is_refused_for_the_angle_method(recorded):
    results = recorded("whu")
    performed = results["segment/performed"].set_index("manoeuvre")
    turns = performed[performed.index.str.contains("360")]
    assert len(turns) == 6 and not turns["complete"].any()
    np.testing.assert_allclose(np.degrees(turns["angle"].abs()), 3.3, atol=0.2)
    np.testing.assert_allclose(np.degrees(turns["missing_angle"].abs()), 356.7, atol=0.2)
    fit = results["gyroscope/fit_manoeuvres"].query("method == 'joint'")
    left = fit.set_index("manoeuvre")["reason"]
    for name in turns.index:
        assert left[name].startswith("the angle method needs the whole turn")
    table = results["gyroscope/parameters"]
    static = table["method"] == "static"
    # Rests alone show the earth, and by it a scale factor that is of no use to anybody.
    shown = table[static & table["parameter"].str.startswith("scale")]
    assert (shown["sigma"] > 0.04).all()
    table = table[~static]
    scales = table[table["parameter"].str.startswith("scale")]
    assert scales["value"].isna().all() and (scales["reason"] != "").all()


def test_whu_gyro_bias_agrees_with_the_published_result(recorded):
    results = recorded("whu")
    bias = results.parameters("gyroscope").loc[["bias_x", "bias_y", "bias_z"]]
    published = np.array([-0.5097616, 0.05342534, 0.02657215]) * ARC_HOUR
    assert np.abs((bias["value"] - published) / bias["sigma"]).max() < 3


# ---- what is wrong with them, as one finds it by looking at the data


def found(results, cause: str) -> pd.DataFrame:
    """The findings of one cause, in the order of time."""
    both = pd.concat([results["quality/findings"], results["segment/findings"]])
    return both[both["cause"] == cause].sort_values("from_s")


def test_whu_has_six_turns_cut_out_and_no_fault_of_time_or_scale(recorded):
    assert len(found(recorded("whu"), "incomplete_turn")) == 6
    others = {"gap", "duplicate", "clock_scale", "clock_jitter", "rate_off", "wrong_day"}
    others |= {"saturation", "dead_axis", "axis_swap", "sign_flip", "wrong_scale_factor"}
    others |= {"gravity_error", "manoeuvre_missing", "wrong_direction", "bias_jump"}
    for cause in others:
        assert found(recorded("whu"), cause).empty, cause


def test_cuyo_clips_its_gyros_at_the_last_count(recorded):
    clipped = found(recorded("cuyo"), "saturation")
    assert list(clipped["count"]) == [3]  # visits: two of x, one of z
    assert "18 readings" in clipped["sentence"].iloc[0]  # twelve of x, six of z, by the file
    np.testing.assert_allclose(clipped["from_s"], [39.10], atol=1e-6)
    # The accelerometers' counts are all multiples of four.
    steps = found(recorded("cuyo"), "quantisation")
    assert list(steps["size"]) == pytest.approx([4 * 9.80665 / 16384])


def test_softdream_has_stamps_of_whole_milliseconds_and_another_rate_than_stated(recorded):
    jitter = found(recorded("softdream"), "clock_jitter")
    assert list(jitter["count"]) == [10]
    assert "11 ms and 12 ms" in jitter["sentence"].iloc[0]
    assert found(recorded("softdream"), "rate_off")["size"].iloc[0] == pytest.approx(
        1.027, abs=1e-3
    )


def test_imucal_is_recorded_without_a_fault(recorded):
    for campaign in ("imucal-labelled", "imucal-continuous"):
        for stage in ("quality", "segment"):
            assert recorded(campaign)[f"{stage}/findings"].empty


def test_hipnuc_warms_by_65_kelvin(recorded):
    (drift,) = found(recorded("hipnuc"), "temperature_drift").itertuples()
    assert drift.size == pytest.approx(66.67 - 1.38, abs=0.01)


# ---- recordings whose positions or plans are for later


def test_softdream_is_read_to_the_end(recorded):
    results = recorded("softdream")
    accounts = results["decode/accounts"]
    assert set(accounts["kind"]) == {"decoded"}
    performed = results["segment/performed"].set_index("manoeuvre")
    quarters = ["x-quarter", "z-quarter", "x-quarter-back"]
    np.testing.assert_allclose(
        np.degrees(performed.loc[quarters, "angle"].astype(float)), [-89.6, -90.0, 90.6], atol=1
    )
    clocks = results["decode/clocks"].set_index("log")
    # Stamps of a millisecond, of which most are 12 ms apart.
    assert clocks.loc["up.txt", "interval"] == pytest.approx(11.888e-3, rel=1e-4)
    # No turn about y: its scale factor is not determined, and said so.
    gyro = results.parameters("gyroscope")
    assert np.isnan(gyro.loc["scale_y", "value"])
    assert "about y" in gyro.loc["scale_y", "reason"]


def test_cuyo_is_calibrated_by_rests_of_unknown_attitude(recorded, recordings):
    results = recorded("cuyo")
    performed = results["segment/performed"].set_index("manoeuvre")
    assert performed.loc["settle", "seconds"] == pytest.approx(36.5, abs=2)
    segments = results["segment/segments"]
    assert segments["manoeuvre"].str.startswith("by-hand-").sum() >= 8
    joint = results.parameters("accelerometer")
    assert joint["value"].isna().all()
    assert joint["reason"].str.contains("attitude").all()
    # Nothing tells how the triad stands in its case, nor whether x and y are square.
    free = results.parameters("accelerometer", "free_positions")
    missing = set(free.index[free["value"].isna()])
    assert missing == {"cross_xy", "cross_yx", "symmetric_xy", *(f"mounting_{a}" for a in "xyz")}
    assert "square" in free.loc["mounting_x", "reason"]
    # params_acc.csv is in counts: their scale over ours is 1 + s.
    assert free["sigma"].dropna().max() < 0.02
    gyro = results.parameters("gyroscope", "free_positions")
    assert gyro.loc[["bias_x", "bias_y", "bias_z"], "value"].notna().all()


def test_hipnuc_bins_are_means_without_time(recorded):
    results = recorded("hipnuc")
    samples = results["decode/samples"]
    still = samples[samples["log"] == "test.log:still"]
    assert len(still) == 30 and still["time"].isna().all()
    assert still["mean_of"].iloc[0] == 19674
    assert still["temperature"].iloc[0] == pytest.approx(273.15 + 1.38)
    turning = samples[samples["log"] == "test.log:turning"]
    assert turning["gyro_z"].isna().sum() == (pd.Series(turning["mean_of"]) == 0).sum()
    performed = results["segment/performed"].set_index("manoeuvre")
    assert np.degrees(performed.loc["turning", "rate"]) == pytest.approx(-49.73, abs=0.05)
    blocks = results["segment/blocks"]
    assert (blocks["to_record"] - blocks["from_record"] == 1).all() and len(blocks) == 60
    assert blocks["count"].iloc[0] == 19674


def test_hipnuc_goes_with_the_temperature_along_no_line(recorded):
    """SOURCE.md: z acceleration has a knee near 30 °C, the scale factor of z is 0.4 % off."""
    causes = recorded("hipnuc")["criticism/findings"].set_index("id")
    causes.index = causes.index.str.removeprefix("criticism/temperature/")
    assert set(causes.index) == {"still/accel", "still/gyro", "turning/scale"}
    assert (causes["p_value"] < 0.005).all()
    still = causes[causes.index.str.startswith("still")]
    assert (still["verdict"] == "unknown_structure").all()
    assert still["sentence"].str.contains("not along a straight line nor a cubic").all()
    # That the scale factor goes along no cubic either has p = 0.0095 after the search.
    scale = causes.loc["turning/scale"]
    assert scale["verdict"] == "one_of_class"
    assert (
        "along a cubic" in scale["sentence"] and "a straight line would leave" in scale["sentence"]
    )
    table = recorded("hipnuc")["criticism/members"]
    table["finding"] = table["finding"].str.removeprefix("criticism/temperature/")
    members = table.groupby("finding")["effect"].agg(list)
    of_accel = ["accel_bias_temperature", "accel_scale_temperature", "table_tilt"]
    assert members["still/accel"] == of_accel
    assert members["still/gyro"] == ["gyro_bias_temperature"]
    assert members["turning/scale"] == ["gyro_scale_temperature", "table_speed_error"]

    accel = causes.loc["still/accel"]
    assert accel["axis"] == "z" and accel["size"] == pytest.approx(9.91491 - 9.78446)
    effects = recorded("hipnuc")["criticism/effects"]
    own = effects[effects["finding"] == "criticism/temperature/still/accel"]
    own = own.set_index("parameter")[["value", "sigma"]]
    knee, below, above = (own.loc[f"{name}_z"].to_list() for name in ("knee", "below", "above"))
    assert 20 < knee[0] - 273.15 < 30 and knee[1] < 3
    assert below[0] == pytest.approx(-5.4e-3, abs=1e-3) and abs(above[0]) < 3 * above[1]
    assert "No tilt changes z so: it would take 9°" in accel["sentence"]
    assert "Omitted: 1 mean" in accel["sentence"]  # of a single sample
    assert "A knee at 40." in causes.loc["still/gyro", "sentence"]  # of its y gyro


def test_hipnuc_is_of_use_for_its_changes_with_temperature(recorded):
    """One attitude shows no bias but its change: by means in test.log, 13.3 mg of z from 30 °C."""
    results = recorded("hipnuc")
    verdict = results["diagnosis/verdict"].set_index("sensor")
    assert (verdict["verdict"] == "usable_within_limits").all()
    assert verdict["sentence"].str.contains("from 1.4 to 65.5 °C").all()
    curves = results["diagnosis/temperature_curves"]
    own = curves[(curves["sensor"] == "accel") & (curves["parameter"] == "bias_z")]
    assert 20 < own["knot"].iloc[0] - 273.15 < 30
    cold, warm = own.iloc[0], own.iloc[-1]
    assert cold["value"] - warm["value"] == pytest.approx(9.91491 - 9.78446, abs=0.012)
    assert own["sigma"].between(1e-3, 2e-2).all()
    assert "scale factor" in own["not_separated"].iloc[0]


def test_every_verdict_says_what_could_not_be_determined(recorded):
    for name in NAMES:
        results = recorded(name)
        text = verdict_of(results)
        assert "Verdict:" in text
        parameters = [results[f"{stage}/parameters"] for stage in ("accelerometer", "gyroscope")]
        told = pd.concat(parameters)
        determined = told[told["method"].str.match("joint|free")]["value"].notna().any()
        assert "not usable" in " ".join(text.split()) or determined, name
        assert "SIMULATED" not in text


@pytest.mark.slow
def test_the_report_of_the_workflow_has_this_verdict(recorded, tmp_path):
    """As a user would run it, in a data folder elsewhere."""
    results = recorded("hipnuc")
    shutil.copytree(results.folder.parents[1] / "raw", tmp_path / "data/raw")
    page = "reports/hipnuc.html"
    command = [sys.executable, "-m", "snakemake", "--cores", "2", "--directory", str(tmp_path)]
    command += ["--snakefile", str(chain.ROOT / "Snakefile"), page]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / page).stat().st_size > 10_000
    text = (tmp_path / "reports/hipnuc.txt").read_text(encoding="utf-8")
    assert text == verdict_of(results)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_every_recording_has_its_page(name, recorded):
    results = recorded(name)
    made = report(**read(results))
    assert len(made["html"]) > 10_000 and made["txt"] == verdict_of(results)


# ---- mikoff_mpu9150, by hand, without time

BY_HAND = """\
campaign: 1
instrument:
  name: MPU-9150
  rate_hz: 100
  format:
    kind: columns
    delimiter: " "
    time: {rate_hz: 100}
    accelerometer: {columns: [1, 2, 3], unit: m/s2}
    gyro: {columns: [4, 5, 6], unit: rad/s}
serial: unknown
date: unknown
site: {latitude_deg: null, gravity_m_s2: 9.81, gravity_sigma_m_s2: 0.02}
table: {name: by hand, position_sigma_arcsec: 3600}
log: imu4.log
plan:
  - {id: rests, do: positions, seconds: 2}
"""


def test_a_blow_against_the_case_reverses_no_axis(recordings, tmp_path):
    """At record 3656 the accelerometers jump by 9.5 m/s², and the gyros stop within 40 ms."""
    folder = tmp_path / "blow"
    folder.mkdir()
    (folder / "campaign.yaml").write_text(BY_HAND)
    (folder / "imu4.log").write_bytes((recordings / "mikoff_mpu9150/imu4.log").read_bytes())
    results = chain.run(folder, tmp_path / "derived", "segment")
    assert not {"sign_flip", "axis_swap"} & set(results["quality/findings"]["cause"])
    assert results["segment/repairs"].empty
