"""Compensated samples: they hold what is known, in the order of the log, and are made once."""

from dataclasses import replace
from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pytest
from in_memory import MemoryStream
from ruamel.yaml import YAML

from inertial.campaign.measurement import EffectOfResult, measurement_of
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import rows_of
from inertial.effects import CATALOGUE, KNOWN
from inertial.physics.forward import Triad, force_of, rate_of
from inertial.physics.motion import Motion, stretches
from inertial.physics.site import EARTH_RATE
from inertial.tables import CHANNELS, SIMULATED, parquet
from inertial.tables.errors import Refusal
from stages.compensation.correction import ALL, held, mounted
from stages.compensation.stage import _of_sensor

DEGREE_PER_HOUR = np.radians(1 / 3600)  # rad/s
QUANTITIES = ["gravity", "force_up", "rate_up", "angle"]
ACCEL, GYRO = list(CHANNELS[:3]), list(CHANNELS[3:])


def checks_of(results: chain.Results, quantity: str) -> pd.DataFrame:
    table = results["compensation/checks"]
    return table[table["quantity"] == quantity].set_index("manoeuvre")


def still(n: int) -> Motion:
    return stretches(np.linspace(0, 600, n), np.full(n, 0.01), np.linspace(290, 300, n))


def test_the_formula_undoes_reading_of_truth():
    triad = Triad(np.array([[1.1, 0.02, 0], [-0.01, 0.9, 0.03], [0, 0, 1]]), np.array([1, 2, 3.0]))
    truth = np.random.default_rng(1).normal(size=(5, 3))
    readings = truth @ triad.matrix.T + triad.bias
    np.testing.assert_allclose(force_of(readings, triad, [], still(5)), truth)
    assert np.isnan(force_of(readings, None, [], still(5))).all()


G = 1.4 * DEGREE_PER_HOUR / 9.8  # rad/s per m/s²


def test_effects_are_taken_out_with_the_force_that_the_accelerometers_tell():
    """By hand: the x gyro reads g f_z and a drift, the x accelerometer f_x and a share of f_x²."""
    force = np.array([[3.0, -2.0, 9.0], [-9.7, 0.1, 0.2]])
    rate = np.array([[1e-5, 2e-5, 3e-5], [0.2, -0.1, 1.0]])
    motion = stretches(np.array([100.0, 700.0]), np.full(2, 0.01), np.full(2, np.nan))
    accel = force + np.array([[2e-5 * 9.0, 0, 0], [2e-5 * 9.7**2, 0, 0]])
    gyro = rate + np.array([[G * 9.0 + 1e-9 * 100, 0, 0], [G * 0.2 + 1e-9 * 700, 0, 0]])
    exact = Triad(np.eye(3), np.zeros(3))
    quadratic = (CATALOGUE["accel_quadratic"], np.array([2e-5, 0, 0]))
    coupled, drift = np.zeros(9), np.array([1e-9, 0, 0])
    coupled[2] = G
    effects = [(CATALOGUE["gyro_g_sensitivity"], coupled), (CATALOGUE["gyro_bias_ramp"], drift)]
    found = force_of(accel, exact, [quadratic], motion)
    np.testing.assert_allclose(found, force, rtol=1e-12)
    np.testing.assert_allclose(rate_of(gyro, exact, effects, motion, found), rate, rtol=1e-9)


def test_an_effect_that_swallows_the_reading_leaves_nothing():
    lost = (CATALOGUE["gyro_scale_asymmetry"], np.array([-1.0, -1.0, -1.0]))  # 0 for ω > 0
    exact = Triad(np.eye(3), np.zeros(3))
    unknown = rate_of(np.full((1, 3), 0.5), exact, [lost], still(1), np.zeros((1, 3)))
    assert np.isnan(unknown).all()


def test_between_records_of_the_accelerometers_their_last_force_holds():
    nan = np.full(3, np.nan)
    force = np.array([nan, [0, 0, 9.0], nan, [0, 9.0, 0], nan])
    before = np.array([9.0, 0, 0])
    expected = [[9.0, 0, 0], [0, 0, 9.0], [0, 0, 9.0], [0, 9.0, 0], [0, 9.0, 0]]
    np.testing.assert_array_equal(held(force, before), expected)


# ---- physics, on clean campaigns


def test_after_compensation_everything_is_what_it_should_be(clean):
    for results in clean:
        table = results["compensation/checks"]
        assert set(table["quantity"]) == set(QUANTITIES)
        assert table["id"].is_unique
        assert table["in_sigmas_after"].abs().max() < 4
        assert len(checks_of(results, "angle")) == 6
        assert len(checks_of(results, "gravity")) == 18  # six rests, and two around each turn
    for quantity in QUANTITIES:
        pulls = pd.concat([checks_of(r, quantity)["in_sigmas_after"] for r in clean])
        # The parameters are from these data, so that what is left is less than the noise.
        assert 0.3 < np.sqrt(np.mean(pulls**2)) < 1.3


@pytest.mark.slow
def test_checks_allow_for_a_bias_instability(tmp_path):
    """3 °/h, which the noise at rest shows: without it in their sigmas the turns are 20 off."""
    document = chain.demo(effects={"gyro_flicker": {"instability_deg_h": 3.0}}, seed=5)
    raw = chain.simulate(document, tmp_path / "raw/flicker")
    results = chain.run(raw, tmp_path / "derived/flicker", "compensation", chain.BESIDE)
    for quantity in ("rate_up", "angle"):
        pulls = checks_of(results, quantity)["in_sigmas_after"]
        assert 0.5 < np.sqrt(np.mean(pulls**2)) < 1.6


def test_before_compensation_it_is_not(clean):
    truth = chain.demo()["truth"]["gyro"]
    for results in clean:
        gravity = checks_of(results, "gravity").loc[["x-up", "x-down", "y-up", "y-down", "z-down"]]
        off = (gravity["before"] - gravity["expected"]).abs()
        assert (off > 100 * gravity["after_sigma"]).all()
        angle = checks_of(results, "angle")
        for i, axis in enumerate("xyz"):
            ratio = angle.loc[f"{axis}-forward", "before"] / (2 * np.pi) - 1
            # The scale factor, and the bias over 38.9 s.
            expected = truth["matrix"][i][i] - 1 + truth["bias_rad_s"][i] * 38.9 / (2 * np.pi)
            assert ratio == pytest.approx(expected, abs=2e-5)


def test_the_earths_rate_is_taken_out_of_the_angle(clean):
    # 15 °/h · sin φ for 38.9 s is 297″, sixty sigma: without it no turn would agree.
    angle = checks_of(clean[0], "angle")
    known = clean[0]["plan/known"].set_index("quantity")["value"]
    assert (known["earth_rate_up"] * 38 > 50 * angle["after_sigma"]).all()
    assert (angle["in_sigmas_after"].abs() < 4).all()


@pytest.mark.slow
def test_a_hidden_g_sensitivity_is_taken_out(coupled):
    """A corrected rest reads the earth's rate, 7.64 °/h at Wuhan, for all its g-sensitivity.

    Without the effects of the result the 14 °/h that gravity adds to the x gyro are left in it.
    """
    rates = checks_of(coupled, "rate_up")
    assert rates["expected"].iloc[0] / DEGREE_PER_HOUR == pytest.approx(7.640, abs=1e-3)
    assert (rates["in_sigmas_after"].abs() < 4).all()
    assert (checks_of(coupled, "angle")["in_sigmas_after"].abs() < 4).all()
    result = coupled["diagnosis/result"]
    twelve = result[result["effect"].isna()]
    plain = chain.again(coupled, "compensation", result=twelve)["checks"]
    plain = plain[plain["quantity"] == "rate_up"].set_index("manoeuvre")
    off = (plain.loc["x-up", "after"] - rates.loc["x-up", "after"]) / DEGREE_PER_HOUR
    assert off == pytest.approx(14, abs=0.5)
    assert plain.loc["x-up", "in_sigmas_after"] > 10
    assert "not all there is" in plain.loc["x-up", "sentence"]


# ---- what the result leaves over


def in_sigmas(residuals: pd.DataFrame, *phases: str) -> pd.DataFrame:
    own = residuals[residuals["phase"].isin(phases)]
    return pd.DataFrame({c: own[f"residual_{c}"] / own[f"sigma_{c}"] for c in CHANNELS})


def test_the_result_leaves_the_noise_over_in_every_channel(clean):
    for results in clean:
        table = results["compensation/residuals"]
        rest = in_sigmas(table, "rest", "rest-before", "rest-after")
        # Of some 400 blocks a ratio of 1 is known to 4 %; a few parameters are from these data.
        assert np.sqrt((rest**2).mean()).between(0.85, 1.15).all()
        turn = in_sigmas(table, "steady")
        assert turn[ACCEL].isna().all(axis=None)  # they are not fitted while the table turns
        assert np.sqrt((turn[GYRO] ** 2).mean()).between(0.75, 1.25).all()
        assert (rest.abs() > 3).mean().max() < 0.02


@pytest.mark.slow
def test_the_result_leaves_the_noise_over_beside_a_table_that_is_not_level(tmp_path):
    """The tilts of the joint fit, which had taken up a part of the lean, left twice the noise."""
    tilted = chain.demo(seed=51, effects={"table_tilt": {"north_arcsec": 25, "east_arcsec": 0}})
    raw = chain.simulate(tilted, tmp_path / "raw")
    results = chain.run(raw, tmp_path / "derived", "compensation", chain.BESIDE)
    assert set(results["diagnosis/causes"]["cause"]) == {"table_tilt"}
    rest = in_sigmas(results["compensation/residuals"], "rest", "rest-before", "rest-after")
    assert np.sqrt((rest**2).mean()).between(0.85, 1.15).all()


def test_residuals_of_turns_and_rests_are_on_one_time(clean):
    """Logs that count from their own first sample, half a minute after the end of the one before.

    The temperature and whatever changes with time are those of that time.
    """
    clocks = clean[0]["decode/clocks"]
    length = clocks["to_s"] - clocks["from_s"]
    began = (length + 30).cumsum().shift(fill_value=0.0)
    own = clocks.assign(clock="own", began=began, from_s=0.0, to_s=length)
    blocks, simulated = (
        table.assign(time=table["time"] - table["log"].map(clocks.set_index("log")["from_s"]))
        for table in (clean[0]["segment/blocks"], clean[0]["simulation/simulated"])
    )
    changed = {"blocks": blocks, "simulated": MemoryStream(SIMULATED.arrow(simulated))}
    moved = chain.again(clean[0], "compensation", clocks=own, **changed)["residuals"]
    before = clean[0]["compensation/residuals"]
    log = blocks.drop_duplicates("manoeuvre").set_index("manoeuvre")["log"]
    zero = pd.Series(began.to_numpy(), index=clocks["log"])
    for table, start in ((moved, zero), (before, clocks.set_index("log")["from_s"])):
        table["since"] = table["time"] - table["manoeuvre"].map(log).map(start)
    for phase in ("rest", "steady"):
        own = (table[table["phase"] == phase] for table in (moved, before))
        middles = [table.groupby("manoeuvre")["since"].mean() for table in own]
        assert len(middles[0]) >= 6
        np.testing.assert_allclose(*middles, atol=1.0)  # s


@pytest.mark.slow
def test_what_the_result_has_wrong_is_left_over(coupled):
    """Without its g-sensitivity, 14 °/h under gravity, the x gyro is off by that with x up."""
    result = coupled["diagnosis/result"]
    plain = chain.again(coupled, "compensation", result=result[result["effect"].isna()])
    off = [
        made.query("manoeuvre == 'x-up'")["residual_gyro_x"].mean() / DEGREE_PER_HOUR
        for made in (plain["residuals"], coupled["compensation/residuals"])
    ]
    assert off[0] == pytest.approx(14, abs=0.5)
    assert abs(off[1]) < 0.5


@pytest.mark.slow
def test_static_positions_are_predicted_about_the_azimuth_of_the_result(coupled):
    """That of the joint fit, which lacks the g-sensitivity, is off by tens of degrees."""
    table = coupled["compensation/residuals"]
    still = table[table["phase"].isin(["rest", "rest-before", "rest-after"])]
    for channel in GYRO:
        weights = still[f"sigma_{channel}"] ** -2.0
        own = still.assign(weights=weights, sums=weights * still[f"residual_{channel}"])
        sums = own.groupby(["manoeuvre", "phase"])[["weights", "sums"]].sum()
        means = sums["sums"] / np.sqrt(sums["weights"])  # in sigma
        assert means.abs().max() < 6  # errors of the parameters beside the noise
        assert np.sqrt((means**2).mean()) < 1.5


# ---- the stream


def test_records_keep_their_order_and_count_and_the_checks_are_about_them(clean):
    results = clean[0]
    samples, compensated = results["decode/samples"], results["compensation/compensated"]
    for name in ("log", "record", "time"):
        assert (compensated[name].astype(object) == samples[name].astype(object)).all()
    segments = results["segment/segments"].set_index(["manoeuvre", "phase"])
    rest = segments.loc[("x-down", "rest")]
    own = compensated[compensated["log"] == rest["log"]]
    own = own[(own["record"] >= rest["from_record"]) & (own["record"] < rest["to_record"])]
    size = np.linalg.norm(own[ACCEL].mean())
    assert size == pytest.approx(checks_of(results, "gravity").loc["x-down", "after"], abs=1e-8)


@pytest.mark.slow
def test_the_same_in_small_batches(clean, monkeypatch):
    whole = chain.again(clean[0], "compensation")
    monkeypatch.setattr(parquet, "BATCH_ROWS", 777)
    small = chain.again(clean[0], "compensation")
    for table in ("compensated", "compensated_traces", "checks"):
        pd.testing.assert_frame_equal(whole[table], small[table], check_categorical=False)


def test_traces_stand_between_the_edges_of_segment_and_hold_the_samples(clean):
    results = clean[0]
    before, after = results["segment/traces"], results["compensation/compensated_traces"]
    edges = ["log", "from_record", "to_record", "from_s", "to_s"]
    pd.testing.assert_frame_equal(before[edges], after[edges])
    compensated = results["compensation/compensated"]
    last = after[after["log"] == "z-up.asc"].iloc[-1]
    own = compensated[compensated["log"] == "z-up.asc"]
    own = own[(own["record"] >= last["from_record"]) & (own["record"] < last["to_record"])]
    for channel in CHANNELS:
        assert own[channel].min() == last[f"least_{channel}"]
        assert own[channel].max() == last[f"most_{channel}"]


# ---- what is not determined, and what was compensated before


@pytest.mark.slow
def test_a_sensor_that_is_not_wholly_determined_stays_empty_and_says_why(clean):
    result = clean[0]["diagnosis/result"]
    lost = (result["sensor"] == "gyro") & (result["parameter"] == "scale_y")
    result.loc[lost, "value"] = np.nan
    result.loc[lost, "reason"] = "no whole turn about y was recorded"
    made = chain.again(clean[0], "compensation", result=result)
    assert made["compensated"][GYRO].isna().all(axis=None)
    assert made["compensated"][ACCEL].notna().all(axis=None)
    checks = made["checks"].set_index("quantity")
    assert checks.loc["gyro", "sentence"].startswith("The gyros are not compensated")
    assert "s_y: no whole turn about y was recorded" in checks.loc["gyro", "sentence"]
    assert not {"rate_up", "angle"} & set(checks.index)


@pytest.mark.slow
def test_of_a_sensor_that_is_not_usable_nothing_is_compensated(clean):
    result = clean[0]["diagnosis/result"]
    unusable = result["sensor"] == "accel"
    result.loc[unusable, ["value", "sigma"]] = np.nan
    result.loc[unusable, "reason"] = "gravity is not what is stated"
    made = chain.again(clean[0], "compensation", result=result)
    assert made["compensated"][ACCEL].isna().all(axis=None)
    assert made["compensated"][GYRO].notna().all(axis=None)
    checks = made["checks"].set_index("quantity")
    assert checks.loc["accelerometer", "sentence"] == (
        "The accelerometers are not compensated: gravity is not what is stated."
    )
    assert not {"gravity", "force_up"} & set(checks.index)


@pytest.mark.slow
def test_an_effect_of_the_table_stays_in_the_readings(clean):
    """The table wobbles, the IMU feels it: M and bias were estimated beside it."""
    result = clean[0]["diagnosis/result"]
    wobble = result.iloc[:1].assign(
        id="wobble", effect="table_wobble", parameter="table_wobble.north", value=1e-3
    )
    made = chain.again(clean[0], "compensation", result=pd.concat([result, wobble]))
    same = chain.again(clean[0], "compensation")
    pd.testing.assert_frame_equal(made["compensated"], same["compensated"])
    (sentence,) = made["checks"].query("quantity == 'effect'")["sentence"]
    assert "table wobble, which stays" in sentence


def test_each_mount_has_its_own_parameters_and_between_them_nothing_is_known(clean):
    plan = clean[0]["plan/manoeuvres"].iloc[:4].assign(log="one.asc")
    plan["mount"] = ["flat", "flat", "on edge", "on edge"]
    segments = pd.DataFrame(
        {
            "manoeuvre": list(plan["manoeuvre"]),
            "log": "one.asc",
            "from_record": [10, 200, 500, 700],
            "to_record": [100, 300, 600, 800],
        }
    )
    clocks = clean[0]["decode/clocks"].iloc[:1].assign(log="one.asc")
    mounts = chain.mounts(clean[0], manoeuvres=plan, clocks=clocks)
    own = {mount.mount: measurement_of([]) for mount in mounts}
    parts = mounted(mounts, own, segments)["one.asc"]
    assert [(part.first, part.after) for part in parts] == [(10, 300), (500, 800)]
    assert mounts[1].mount == "on edge" and parts[1].measurement is own["on edge"]
    single = chain.mounts(clean[0], manoeuvres=plan.assign(mount="flat"), clocks=clocks)
    alone = mounted(single, {}, segments)["one.asc"]
    assert [(part.first, part.after) for part in alone] == [(0, ALL)]


@pytest.fixture(scope="module")
def compensated_before(tmp_path_factory) -> chain.Results:
    folder = tmp_path_factory.mktemp("before")
    campaign = chain.simulate(chain.short(seed=3), folder / "before")
    file = campaign / "campaign.yaml"
    file.write_text(f"compensated: true\n{file.read_text(encoding='utf-8')}", encoding="utf-8")
    return chain.run(campaign, folder / "derived", "compensation")


@pytest.mark.slow
def test_a_second_compensation_is_refused_with_a_finding_and_all_else_runs(compensated_before):
    results = compensated_before
    for table in ("compensated", "checks", "compensated_traces"):
        assert results[f"compensation/{table}"].empty
    finding = results["compensation/findings"].iloc[0]
    assert finding["cause"] == "already_compensated" and finding["severity"] == 3
    assert "not compensated again" in finding["sentence"]
    assert results["plan/campaign"]["compensated"].all()
    for stage in ("accelerometer", "gyroscope"):
        assert results.parameters(stage)["value"].notna().all()
    assert not results["comparison/differences"].empty


def test_samples_that_a_compensation_made_are_refused(clean):
    made_by = {"samples": {"stage": "compensation"}}
    with pytest.raises(Refusal, match="made by compensation") as refused:
        chain.again(clean[0], "compensation", provenance=made_by)
    assert "samples of decode" in refused.value.cure
    assert Path(refused.value.file).name == "samples.parquet"


def test_compensated_must_be_true_or_false(tmp_path):
    text = (Path(__file__).parent / "campaigns/s0.yaml").read_text(encoding="utf-8")
    from inertial.tables.yaml_file import YamlFile

    file = tmp_path / "campaign.yaml"
    file.write_text(f"compensated: yes\n{text}", encoding="utf-8")
    with pytest.raises(Refusal, match=r"line 1, compensated"):
        YamlFile(file).check("campaign")


@pytest.mark.slow
def test_without_a_latitude_the_gyros_tell_the_earths_rate(tmp_path):
    """Both components: once it was taken to be level, by 0.8 of it, and residuals were as large."""
    folder = chain.simulate(chain.short(seed=6), tmp_path / "raw")
    file = folder / "campaign.yaml"
    document = YAML(typ="safe").load(file)
    up = EARTH_RATE * np.sin(np.radians(document["site"]["latitude_deg"]))
    document["site"]["latitude_deg"] = None
    YAML(typ="safe").dump(document, file)
    results = chain.run(folder, tmp_path / "derived", "compensation")
    (fit,) = results["gyroscope/fit"].query("method == 'joint'").to_dict("records")
    assert fit["earth_rate_up"] == pytest.approx(up, rel=0.05)
    assert not len(checks_of(results, "rate_up"))  # with what is not known
    left = in_sigmas(results["compensation/residuals"], "rest")[GYRO].to_numpy()
    assert np.sqrt(np.nanmean(left**2)) < 1.2


def test_terms_that_the_result_does_without_take_nothing_of_the_budget(clean):
    """Of a polynomial of temperature on all parameters one term of y: x keeps the sigma it has."""
    (data,) = chain.mounts(clean[0])
    warming = data.blocks.assign(temperature=290.0 + data.blocks["time"] / 60)
    data = replace(data, blocks=warming)
    result, fits = clean[0]["diagnosis/result"], rows_of(clean[0]["accelerometer/fit"])
    measurement = measurement_of(rows_of(result))
    own = measurement.accelerometer
    method = next(iter(own.rows.values()))["method"]
    (fit,) = (row for row in fits if row["method"] == method)
    term = {"parameter": "accel_temperature.bias_y_1", "value": 0.0, "sigma": 1e-5}
    effect = EffectOfResult(KNOWN["accel_temperature"], {"bias_y_1": term}, {})
    rows = list(_of_sensor(campaign_of(data), replace(own, effects=[effect]), fit, data.mount))
    assert {"scale_x", "bias_x", "scale_z"} <= {row["quantity"] for row in rows}
    for name in ("scale_x", "bias_x", "scale_z"):
        variance = sum(row["sigma"] ** 2 for row in rows if row["quantity"] == name)
        assert np.sqrt(variance) == pytest.approx(own.rows[name]["sigma"], rel=0.1)
