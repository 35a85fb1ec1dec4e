"""The models with effects: the parameters come back, what was not seen is predicted."""

import chain
import numpy as np
import pandas as pd
import pytest
from scipy.stats import truncnorm
from test_closure import truth_of

G = 9.80665  # m/s², of the unit of the laboratory's K2
GRAVITY = 9.7936174
SIZE = 90.0  # µg/g², twenty sigma of the short campaign


def run(folder, **changes):
    campaign = chain.simulate(chain.short(**changes), folder / "short")
    return chain.run(campaign, folder / "derived", "diagnosis", chain.BESIDE)


@pytest.fixture(scope="module")
def quadratic(tmp_path_factory):
    """A short campaign whose y accelerometer answers to the square of what it feels."""
    effects = {"accel_quadratic": {"k2_micro_g_g2": [0, SIZE, 0]}}
    return run(tmp_path_factory.mktemp("quadratic"), effects=effects, seed=5)


# ---- the demo


def test_the_parameters_that_the_effect_had_spoiled_come_back(demo_criticised):
    table = demo_criticised.parameters("extension", "extended")
    table = table.reset_index().set_index(["sensor", "parameter"])
    truth = truth_of("gyroscope")
    rows = table.loc["gyro"].loc[list(truth)]
    pulls = (rows["value"] - list(truth.values())) / rows["sigma"]
    assert np.abs(pulls).max() < 4
    joint = demo_criticised.parameters("gyroscope")
    # Sigmas of noise alone again: the scatter that covered the effect is gone.
    assert table.loc[("gyro", "scale_x"), "sigma"] < joint.loc["scale_x", "sigma"] / 3
    assert "accel" not in table.index.get_level_values(0)  # they show nothing of it
    candidates = demo_criticised["extension/candidates"].set_index(["sensor", "method"])
    assert "extended" in candidates.loc["gyro"].index
    assert list(candidates.loc["accel"].index) == ["joint"]


def test_the_gain_is_there_on_data_that_the_fit_has_not_seen(demo_criticised):
    table = demo_criticised["extension/gain"].fillna({"axis": ""})
    gain = table.set_index(["sensor", "axis", "scope", "unit"]).sort_index()
    assert "accel" not in gain.index.get_level_values(0)  # it shows nothing of either effect
    fitted, held_out = (gain.loc["gyro", "", scope, "sigma"] for scope in ("fitted", "held-out"))
    assert fitted["drop"] > 1000 and held_out["drop"] > 1000
    assert 0.9 < held_out["drop"] / held_out["snr_squared"] < 1.1
    assert fitted["rms_after"] < 1.1 < fitted["rms_before"]
    assert held_out["rms_after"] < 1.1 < held_out["rms_before"]
    for axis in "xyz":
        channel = gain.loc["gyro", axis, "held-out", "sigma"]
        assert channel["rms_after"] < 1.3 < channel["rms_before"]
    ringing = gain.loc["gyro", "x", "held-out", "rad/s"]
    assert ringing["rms_after"] < 0.02 * ringing["rms_before"]
    assert ringing["rms_after"] < 4e-5  # rad/s: the white noise of a sample, 3.5e-5


def test_covariance_and_parameters_agree(demo_criticised):
    table = demo_criticised["extension/parameters"].set_index("id")
    covariance = demo_criticised["extension/covariance"]
    own = covariance[covariance["first"] == covariance["second"]].set_index("first")["covariance"]
    np.testing.assert_allclose(np.sqrt(own[table.index]), table["sigma"], rtol=1e-9)


# ---- an effect of twenty sigma


def test_the_effect_and_what_it_moved_come_back(quadratic):
    found = quadratic.parameters("extension", "extended")
    (name,) = set(quadratic["extension/gain_effects"]["effect"])
    assert name in ("accel_quadratic", "accel_scale_asymmetry")  # this plan cannot tell them apart
    if name == "accel_quadratic":
        size = found.loc["accel_quadratic.k2_y"]
        assert abs(size["value"] - SIZE * 1e-6 / G) < 4 * size["sigma"]
        truth = truth_of("accelerometer")
        pulls = (found.loc[list(truth), "value"] - list(truth.values())) / found.loc[
            list(truth), "sigma"
        ]
        assert np.abs(pulls).max() < 4
    moved = quadratic["extension/moved"].set_index("parameter")
    assert set(moved["joint_id"].str.partition("/")[0]) == {"accelerometer"}
    # The mean of the two rests of y is off by K2 g², which the joint fit takes for a bias.
    assert moved.loc["bias_y", "in_sigmas"] < -4
    assert moved["in_sigmas"].drop(["bias_y", "scale_y", "cross_yx", "cross_yz"]).abs().max() < 1


def test_the_held_out_drop_is_the_snr_squared_at_stake(quadratic):
    table = quadratic["extension/gain"].fillna({"axis": ""})
    gain = table.set_index(["sensor", "axis", "scope"])
    fitted, held_out = (gain.loc["accel", "", scope] for scope in ("fitted", "held-out"))
    assert 15**2 < fitted["snr_squared"] < 25**2
    assert 0.8 < held_out["drop"] / fitted["snr_squared"] < 1.6
    assert 0.8 < held_out["drop"] / held_out["snr_squared"] < 1.2
    loud = gain.loc["accel", "y", "fitted"]
    assert loud["rms_after"] < 1.3 < loud["rms_before"] and loud["drop"] > 0.9 * fitted["drop"]
    for quiet in "xz":
        assert abs(gain.loc["accel", quiet, "fitted"]["drop"]) < 12  # of noise, a parameter or two


def test_a_rest_that_alone_shows_it_is_not_counted_and_that_is_said(quadratic):
    table = quadratic["extension/gain"]
    whole = table[table["axis"].isna()].set_index(["sensor", "scope"])
    held_out, folds = whole.loc["accel", "held-out"], quadratic["extension/held_out"]
    own = folds[(folds["sensor"] == "accel") & ~folds["counted"]]
    assert list(own["manoeuvre"]) == ["y-down"]  # the turns show y upward as well
    assert (held_out["folds"], held_out["counted"]) == (12, 11)
    told = quadratic["extension/candidates"].set_index(["sensor", "method"])
    extended = told.loc["accel", "extended"]
    assert (extended["folds"], extended["counted"]) == (12, 11)
    assert extended["carried_by"] == "y-down"
    for words in ("Not counted: y-down", "Without y-down the others do not show"):
        assert words in extended["sentence"]


def test_each_member_of_the_class_is_a_candidate(quadratic):
    """K2 and an asymmetry of scale: at ±g one reads k2 g² where the other reads a g.

    And so does a bias in that position alone, which may be in any of six, and is less likely.
    """
    candidates = quadratic["extension/candidates"].set_index("sensor")
    assert candidates.loc["gyro", "method"] == "joint"
    own = candidates.loc["accel"].set_index("method")
    assert list(own.index) == ["joint", "extended", "member_1", "member_2"]
    assert own.loc["joint", "probability"] == 0.0
    assert own["probability"].sum() == pytest.approx(1.0)
    extended, member, bias = own["probability"].iloc[1:]
    assert extended == pytest.approx(member, rel=0.02) and 0.01 < bias < extended / 3
    assert own["undetermined"].eq(0).all()
    effects = quadratic["extension/candidate_effects"].set_index("method")["effect"]
    bias_of_position = effects.pop("member_2")
    assert bias_of_position == "accel_bias_of_position"
    assert set(effects) == {"accel_quadratic", "accel_scale_asymmetry"}
    by_effect = {name: quadratic.parameters("extension", m) for m, name in effects.items()}
    k2 = by_effect["accel_quadratic"].loc["accel_quadratic.k2_y"]
    a = by_effect["accel_scale_asymmetry"].loc["accel_scale_asymmetry.a_y"]
    # Both go with M · f: at ±g along y as M_yy g, in level rests |f| still has a share of the rest.
    linear = by_effect["accel_quadratic"]["value"]
    level = np.abs(linear[["cross_yx", "cross_yz"]]).mean()
    upright = 1 + linear["scale_y"]
    expected = k2["value"] * GRAVITY * upright**2 / (upright - level)
    assert a["value"] == pytest.approx(expected, rel=1e-3)
    assert a["sigma"] == pytest.approx(k2["sigma"] * GRAVITY, rel=1e-2)


def test_ids_are_unique_and_each_candidate_has_its_covariance(quadratic):
    parameters, covariance = (quadratic[f"extension/{of}"] for of in ("parameters", "covariance"))
    assert parameters["id"].is_unique
    assert set(parameters["id"].str.rpartition("/")[0]) == {
        "extension/accelerometer",
        "extension/member_1/accelerometer",
        "extension/member_2/accelerometer",
    }
    own = covariance[covariance["first"] == covariance["second"]].set_index("first")["covariance"]
    sigma = parameters.set_index("id")["sigma"].dropna()  # a position has none
    np.testing.assert_allclose(np.sqrt(own[sigma.index]), sigma, rtol=1e-9)
    fit = quadratic["extension/fit"].set_index("method")
    assert set(fit.index) == {"extended", "member_1", "member_2"}
    assert abs(fit.loc["extended", "chi_squared"] - fit.loc["member_1", "chi_squared"]) < 0.1
    assert set(quadratic["extension/fit_manoeuvres"]["method"]) == set(fit.index)


def test_unknown_probabilities_follow_from_the_evidence(quadratic):
    """Two members explain the data alike, so each is as probable as the other."""
    members = quadratic["criticism/members"].assign(probability=None)
    made = chain.again(quadratic, "extension", members=members)
    own = made["candidates"].query("sensor == 'accel' and method != 'joint'")
    one, other, bias = own["probability"]
    assert one == pytest.approx(other, rel=0.02) and 0.01 < bias < one / 3


def test_a_member_that_the_sensor_does_not_show_leaves_its_joint_fit(quadratic):
    """A bias of the gyros instead: then the accelerometers have no effect at all."""
    members = quadratic["criticism/members"].query("rank < 3")
    other = members["rank"] == 2
    changed = members.assign(effect=members["effect"].mask(other, "gyro_bias_ramp"))
    made = chain.again(quadratic, "extension", members=changed)
    candidates = made["candidates"].set_index(["sensor", "method"])["probability"]
    assert dict(candidates["accel"]) == pytest.approx({"joint": 0.5, "extended": 0.5}, abs=0.02)
    assert dict(candidates["gyro"]) == pytest.approx({"joint": 0.5, "member_1": 0.5}, abs=0.02)


@pytest.mark.slow
def test_a_scanned_member_gets_its_value_from_the_data(tmp_path):
    """A jump of a gyro half way, of which criticism is made to say that a ramp is likelier."""
    results = run(
        tmp_path, effects={"gyro_bias_jump": {"at_s": 150, "size_deg_h": [0, 0, 60]}}, seed=3
    )
    jump = results["criticism/findings"].iloc[0]
    assert jump["cause"] == "gyro_bias_jump"
    findings = (
        results["criticism/findings"]
        .iloc[:1]
        .assign(cause="gyro_bias_ramp", verdict="one_of_class")
    )
    member = {"finding": jump["id"], "mount": "", "probability": 0.5, "captured": 1.0}
    members = pd.DataFrame(
        [
            member | {"rank": rank, "effect": effect}
            for rank, effect in ((1, "gyro_bias_ramp"), (2, "gyro_bias_jump"))
        ]
    )
    made = chain.again(
        results,
        "extension",
        criticism_findings=findings,
        members=members,
        effects=results["criticism/effects"].iloc[:0],
    )
    fit = made["fit"].set_index(["sensor", "method"])["chi_squared"]
    assert fit["gyro", "member_1"] < fit["gyro", "extended"]
    own = made["parameters"].query("method == 'member_1'").set_index("parameter")
    size = own.loc["gyro_bias_jump.b_z"]
    assert abs(size["value"] - np.radians(60 / 3600)) < 4 * size["sigma"]
    scores = results["criticism/scores"].set_index("effect")
    at = own.loc["gyro_bias_jump.t0", "value"]
    # Between these rests no time of a jump is likelier than another.
    assert all(90 < time < 170 for time in (at, scores.loc["gyro_bias_jump", "scan_value"]))


def test_the_worth_is_the_error_of_the_joint_result_by_hand(quadratic):
    worth = quadratic["extension/worth"].set_index("manoeuvre")
    moved = quadratic["extension/moved"].set_index("parameter")
    effects = quadratic.parameters("extension", "extended")
    (name,) = set(quadratic["extension/gain_effects"]["effect"])
    force = GRAVITY * np.array([0, -1, 0])  # y down
    error = np.zeros(3)
    for i, row in enumerate("xyz"):
        change = moved.loc[f"bias_{row}", "difference"]
        for j, column in enumerate("xyz"):
            element = f"scale_{row}" if i == j else f"cross_{row}{column}"
            change += moved.loc[element, "difference"] * force[j]
        term = "k2" if name == "accel_quadratic" else "a"
        felt = force[i] ** 2 if name == "accel_quadratic" else abs(force[i])
        error[i] = change + effects.loc[f"{name}.{term}_{row}", "value"] * felt
    # M differs from the unit matrix by less than 1 %, and so does what it does to the error.
    row = worth.loc["y-down"]
    assert row["velocity_joint"] == pytest.approx(60 * np.linalg.norm(error), rel=0.02)
    assert row["velocity_joint"] > 5 * row["velocity_joint_sigma"]
    assert (row["attitude_joint"], row["motion"]) == (0.0, "rest")
    assert worth.loc["x-forward", "motion"] == "turn"
    assert worth.loc["x-forward", "rate"] == pytest.approx(np.radians(60), rel=0.3)


# ---- an effect as small as it may be to be named


def test_what_was_only_just_named_is_taken_less_of(quadratic):
    """Had 92 % of its χ² been needed to name it: the sizes shrink, the others follow them."""
    findings = quadratic["criticism/findings"]
    barely = findings.assign(threshold=0.92 * findings["statistic"])
    made = chain.again(quadratic, "extension", criticism_findings=barely)
    (degrees,) = findings["degrees"]
    snr, needed = np.sqrt(findings["statistic"] - degrees), np.sqrt(0.92 * findings["statistic"])
    for method in ("extended", "member_1"):
        before = quadratic.parameters("extension", method)
        after = made["parameters"].query("method == @method").set_index("parameter")
        own = before["effect"].notna()
        ratio = (after.loc[own, "value"] / before.loc[own, "value"]).to_numpy(np.float64)
        # Of one parameter that exceeds a threshold: the mean of a truncated normal.
        expected = 1 - (truncnorm(needed - snr, np.inf).mean() / snr)[0]
        assert ratio == pytest.approx(np.full(own.sum(), ratio[0]), rel=1e-3)
        assert ratio[0] == pytest.approx(expected, abs=0.01) and ratio[0] < 0.99
    # The twelve move with the effect, as the conditional mean of a Gaussian.
    before = quadratic.parameters("extension", "extended").set_index("id")
    after = made["parameters"].set_index("id").loc[before.index]
    spread = quadratic["extension/covariance"].pivot(
        index="first", columns="second", values="covariance"
    )
    own, twelve = before.index[before["effect"].notna()], before.index[before["effect"].isna()]
    change = after["value"] - before["value"]
    weights = np.linalg.solve(spread.loc[own, own], change[own])
    np.testing.assert_allclose(
        change[twelve] / before.loc[twelve, "sigma"],
        spread.loc[twelve, own] @ weights / before.loc[twelve, "sigma"],
        atol=1e-6,
    )
    assert (change[twelve].abs() / before.loc[twelve, "sigma"]).max() > 0.2
    # What the fit has not seen is predicted as before: no size of it enters there.
    own = ["sensor", "method", "drop", "snr_squared", "probability"]
    pd.testing.assert_frame_equal(made["candidates"][own], quadratic["extension/candidates"][own])
    covariance = made["covariance"]
    diagonal = covariance[covariance["first"] == covariance["second"]].set_index("first")
    sigma = made["parameters"].set_index("id")["sigma"].dropna()
    np.testing.assert_allclose(np.sqrt(diagonal["covariance"][sigma.index]), sigma, rtol=1e-9)


# ---- nothing to add


@pytest.mark.slow
def test_without_a_named_effect_the_joint_result_is_the_only_candidate(tmp_path):
    results = run(tmp_path, seed=21)
    for table in ("parameters", "covariance", "fit", "gain", "moved", "worth"):
        assert results[f"extension/{table}"].empty
    assert list(results["extension/candidates"]["method"]) == ["joint", "joint"]
    assert set(results["diagnosis/verdict"]["method"]) == {"joint"}
    result = results["diagnosis/result"].set_index("id")
    for stage in ("gyroscope", "accelerometer"):
        joint = results.parameters(stage)
        own = result[result.index.str.startswith(f"diagnosis/{stage}/")].set_index("parameter")
        assert len(own) == 12
        pd.testing.assert_frame_equal(
            own[["value", "sigma"]], joint.loc[own.index, ["value", "sigma"]]
        )
