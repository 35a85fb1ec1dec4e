"""Rests of unknown attitude from blocks to rows: what is used, what is left out, what is told."""

from dataclasses import fields, replace

import numpy as np
import pandas as pd
import pytest
from moved_by_hand import (
    FACES,
    GIVEN,
    LEVEL,
    MPU6050,
    TWENTY_FOUR,
    UP,
    Imu,
    handled,
)

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import Estimates
from inertial.campaign.noise_levels import NoiseLevels, effective_levels
from inertial.campaign.records import Known, Manoeuvre, labels, omissions, parts_of, rows_of
from inertial.campaign.unknown_attitude import (
    add_free_accelerometers,
    free_static_positions,
    in_words,
)
from inertial.estimation.between_positions import Stop
from inertial.estimation.multi_position import Unobservable
from inertial.tables import CHANNELS
from stages.gyroscope.free_positions import add_free_gyros

KNOWN = {
    "gravity": Known(GIVEN.gravity, GIVEN.gravity_sigma),
    "earth_rate_up": Known(UP, 1e-10),
    "earth_rate_level": Known(LEVEL, None),
}
LOG = "by-hand.csv"


def manoeuvre(name, do, up=None):
    nothing = dict.fromkeys(field.name for field in fields(Manoeuvre))
    stated = {"name": name, "do": do, "log": LOG, "position": name, "mount": "", "up": up}
    return Manoeuvre(**{**nothing, **stated, "recorded": "whole", "seconds": 1.0})


PLAN = [manoeuvre("settle", "rest"), manoeuvre("by-hand", "positions")]


def noise(imu, drifts=None):
    levels = {"accel": imu.noise[0], "gyro": imu.noise[1]}
    return NoiseLevels(
        effective_levels(
            pd.DataFrame(
                {
                    "manoeuvre": "settle",
                    "phase": "rest",
                    "channel": channel,
                    "white_noise": levels[channel[:-2]],
                    "sigma": 0.01 * levels[channel[:-2]],
                    "per_sample": 10 * levels[channel[:-2]],
                }
                for channel in CHANNELS
            ),
            drifts,
        )
    )


def blocks_of(stops, passages):
    """One block for each rest, one for each record between: as the stage segment makes them."""
    rows, record = [], 0

    def add(name, phase, records, seconds, values):
        rows.append(
            {"manoeuvre": name, "phase": phase, "log": LOG, "from_record": record}
            | {"to_record": record + records, "seconds": seconds, "count": float(records)}
            | {"missing_s": 0.0, "time": record / 100 + seconds / 2, "temperature": np.nan}
            | dict(zip(CHANNELS, values, strict=True))
        )
        return record + records

    names = ["settle", *(f"by-hand-{i:02d}" for i in range(1, len(stops)))]
    for i, stop in enumerate(stops):
        values = [*stop.forces.mean, *stop.mean]
        record = add(names[i], "rest", round(100 * stop.seconds), stop.seconds, values)
        for rates in passages[i].rates if i < len(passages) else []:
            moved = f"{names[i]} to {names[i + 1]}"
            record = add(moved, "between", 1, 0.01, [*np.zeros(3), *rates])
    return pd.DataFrame(rows)


@pytest.fixture(scope="module")
def imu():
    return Imu(np.random.default_rng(1), noise=MPU6050, bias=(0.02, 1e-2))


@pytest.fixture(scope="module")
def recorded(imu):
    return blocks_of(*handled(imu, TWENTY_FOUR[:18], 20))


def rows(add, stage, blocks, imu, plan=PLAN):
    estimates = Estimates(stage)
    add(estimates, CampaignData(plan, {}, blocks, noise(imu), KNOWN))
    tables = estimates.tables()
    parameters = tables["parameters"]
    assert parameters.empty or set(parameters["method"]) == {"free_positions"}
    parts = parts_of(rows_of(tables["fit_manoeuvres"]))
    fit = tables["fit"].assign(used=labels(parts), left_out=omissions(parts))
    return parameters.set_index("parameter"), fit, tables["covariance"]


def test_accelerometers(imu, recorded):
    table, fit, covariance = rows(add_free_accelerometers, "accelerometer", recorded, imu)
    names = [f"symmetric_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz")]
    truth = imu.free - [1, 1, 1, 0, 0, 0, 0, 0, 0]
    told = table.loc[[*names, "bias_x", "bias_y", "bias_z"]]
    assert np.abs((told["value"] - truth) / told["sigma"]).max() < 3.5
    # The axes are such that M = P, so the cross terms are alike; the mounting is not told.
    assert table.loc["cross_xy", "value"] == table.loc["cross_yx", "value"]
    assert table.loc["scale_y", "value"] == table.loc["symmetric_yy", "value"]
    mounting = table.loc[["mounting_x", "mounting_y", "mounting_z"]]
    assert mounting["value"].isna().all()
    assert mounting["reason"].str.contains("upward direction is known").all()
    assert fit.loc[0, "degrees"] == 18 - 9 and fit.loc[0, "p_value"] > 0.01
    assert fit.loc[0, "used"].startswith("settle, by-hand-01, by-hand-02")
    assert len(covariance) == 18**2


def test_gyros(imu, recorded):
    table, fit, _ = rows(add_free_gyros, "gyroscope", recorded, imu)
    values = table.loc[["scale_x", "cross_xy", "cross_zx", "scale_z", "bias_y"]]
    truth = [imu.gyro[0, 0] - 1, imu.gyro[0, 1], imu.gyro[2, 0], imu.gyro[2, 2] - 1]
    truth = np.append(truth, imu.rate_bias[1])
    assert np.abs((values["value"] - truth) / values["sigma"]).max() < 3.5
    assert "by-hand-01 to by-hand-02" in fit.loc[0, "used"] and not fit.loc[0, "left_out"]


def test_a_motion_with_masked_records_is_left_out_by_name(imu, recorded):
    inside = recorded["manoeuvre"] == "by-hand-03 to by-hand-04"
    hidden = recorded.index[inside][80:92]
    _, fit, _ = rows(add_free_gyros, "gyroscope", recorded.drop(index=hidden), imu)
    assert fit.loc[0, "left_out"] == (
        "by-hand-03 to by-hand-04: 12 records are masked while it moves,"
        " so no attitude is carried through"
    )
    assert "by-hand-03 to by-hand-04" not in fit.loc[0, "used"]
    assert "by-hand-04 to by-hand-05" in fit.loc[0, "used"]


def test_records_that_repeat_the_one_before_cost_no_motion(imu, recorded):
    """One of a hundred came twice, stamp and all: no gyro had a scale factor."""
    moving = recorded["phase"] == "between"
    repeats = np.cumsum(moving & (np.cumsum(moving) % 100 == 50)).to_numpy()
    later = {name: recorded[name] + repeats for name in ("from_record", "to_record")}
    _, fit, _ = rows(add_free_gyros, "gyroscope", recorded.assign(**later), imu)
    assert not fit.loc[0, "left_out"]


def with_holes(recorded, samples):
    """The blocks without every hundredth record of the motions and those after it."""
    moving = (recorded["phase"] == "between").to_numpy()
    number = np.cumsum(moving)
    hidden = moving & ((number + 50) % 100 < samples)
    seconds = float(recorded.loc[moving, "seconds"].median())
    behind = np.roll(hidden, 1) & ~hidden
    return recorded.assign(missing_s=np.where(behind, samples * seconds, 0.0))[~hidden]


def test_samples_that_a_link_loses_here_and_there_cost_no_motion(imu, recorded):
    """One of a hundred: all gyros had "hardly turned", for no motion was used."""
    table, fit, _ = rows(add_free_gyros, "gyroscope", with_holes(recorded, 1), imu)
    assert not fit.loc[0, "left_out"]
    values = table.loc[["scale_x", "cross_xy", "cross_zx", "scale_z"]]
    truth = [imu.gyro[0, 0] - 1, imu.gyro[0, 1], imu.gyro[2, 0], imu.gyro[2, 2] - 1]
    assert np.abs((values["value"] - truth) / values["sigma"]).max() < 3.5


def test_of_longer_holes_the_motions_are_left_out_and_that_is_the_reason(imu, recorded):
    table, fit, _ = rows(add_free_gyros, "gyroscope", with_holes(recorded, 8), imu)
    assert "are lost or masked while it moves" in fit.loc[0, "left_out"]
    assert "carry no attitude; of settle to by-hand-01: 0.16 s" in table.loc["scale_x", "reason"]


def test_where_the_imu_was_turned_the_reason_is_not_that_it_was_not(imu):
    """Turns of 90° that end 8° beside the rests tell a scale factor to a few per cent."""
    stops, passages = handled(imu, FACES[[0, 2, 1, 3]], 20)
    rng = np.random.default_rng(4)
    slipping = [
        replace(p, rates=p.rates + np.radians(8) / 2 * rng.standard_normal(3)) for p in passages
    ]
    table, _, _ = rows(add_free_gyros, "gyroscope", blocks_of(stops, slipping), imu)
    reason = table.loc["scale_z", "reason"]
    assert "turned about z while z was horizontal" in reason and "known to ±" in reason
    upright = handled(imu, FACES[[4, 4, 4, 4]], 20)  # turned about the vertical alone
    table, _, _ = rows(add_free_gyros, "gyroscope", blocks_of(*upright), imu)
    assert "hardly turned about z" in str(table.loc["scale_z", "reason"])


def test_without_blocks_of_the_motions_the_gyros_say_so(imu, recorded):
    table, fit, _ = rows(add_free_gyros, "gyroscope", recorded[recorded["phase"] == "rest"], imu)
    assert "the motion between them is not recorded" in fit.loc[0, "left_out"]
    assert table.loc[["bias_x", "bias_y", "bias_z"], "value"].notna().all()
    assert np.isnan(table.loc["scale_x", "value"])
    assert "the motion between them is not recorded" in table.loc["scale_x", "reason"]


def test_what_six_faces_do_not_tell_is_said_with_the_rest_that_would(imu):
    faces = blocks_of(*handled(imu, FACES, 3))
    table, _, _ = rows(add_free_accelerometers, "accelerometer", faces, imu)
    assert table.loc["cross_yx", "reason"] == table.loc["symmetric_xy", "reason"]
    assert table.loc["symmetric_xy", "reason"] == (
        "no rest has both x and y far from level, which would show their angle: add one with"
        " +x and +y both 45° above level, and z level"
    )
    assert table.loc[["bias_x", "scale_z", "symmetric_yy"], "value"].notna().all()


def test_where_every_attitude_is_known_the_method_has_no_rows(imu, recorded):
    plan = [manoeuvre("settle", "rest", np.array([0.0, 0.0, 1.0]))]
    for add, stage in (
        (add_free_accelerometers, "accelerometer"),
        (add_free_gyros, "gyroscope"),
    ):
        assert rows(add, stage, recorded, imu, plan)[0].empty


def test_an_accelerometer_that_is_not_recorded_is_named(imu, recorded):
    unread = recorded.assign(accel_y=np.nan)
    found, left = free_static_positions(CampaignData(PLAN, {}, unread, noise(imu), KNOWN))
    assert not found and left[0].omission == "settle: |f| = g needs y too"
    table, _, _ = rows(add_free_accelerometers, "accelerometer", unread, imu)
    assert table["value"].isna().all()


def every_way(imu, number):
    """Positions whose upward directions lie at random."""
    ups = np.random.default_rng(5).normal(size=(number, 3))
    turned = ups / np.linalg.norm(ups, axis=1)[:, None]
    stops = [
        Stop(imu.rest("", up, 20), *np.full((2, 3), np.nan), 20)  # no gyro is recorded
        for up in turned
    ]
    return blocks_of(stops, [])


def accelerometers_alone(blocks, imu):
    estimates = Estimates("accelerometer")
    raised = add_free_accelerometers(estimates, CampaignData(PLAN, {}, blocks, noise(imu), KNOWN))
    tables = estimates.tables()
    fit = tables["fit_manoeuvres"].set_index("manoeuvre")
    return tables["parameters"].set_index("parameter"), fit, raised


def test_positions_that_were_moved_while_they_were_read_are_named_and_left_out(imu):
    """0.5 and 0.8 m/s² too short: with them biases are 0.1 m/s² off, and nothing was said."""
    recorded = every_way(imu, 48)
    means = recorded[["accel_x", "accel_y", "accel_z"]].to_numpy()
    short = means.copy()
    for number, size in ((11, 0.5), (34, 0.8)):
        short[number] *= 1 - size / np.linalg.norm(means[number])
    struck = recorded.assign(accel_x=short[:, 0], accel_y=short[:, 1], accel_z=short[:, 2])
    table, fit, (finding,) = accelerometers_alone(struck, imu)
    assert "by-hand-34" in finding.sentence and "by-hand-11" in finding.sentence
    assert finding.size == pytest.approx(-0.8, abs=0.01) and finding.count == 2
    assert set(fit.index[fit["reason"].fillna("") != ""]) == {"by-hand-11", "by-hand-34"}
    names = [f"symmetric_{pair}" for pair in ("xx", "yy", "zz", "xy", "xz", "yz")]
    told = table.loc[[*names, "bias_x", "bias_y", "bias_z"]]
    truth = imu.free - [1, 1, 1, 0, 0, 0, 0, 0, 0]
    assert np.abs((told["value"] - truth) / told["sigma"]).max() < 3.5
    assert told["sigma"].max() < 2e-3
    assert not accelerometers_alone(recorded, imu)[2]


@pytest.mark.parametrize("number", [20, 24])
def test_one_position_of_few_that_was_moved_is_named_and_left_out(imu, number):
    """Of the others ten or fourteen degrees of freedom are left; it is 60 times their noise off."""
    recorded = every_way(imu, number)
    size = 60 * imu.noise[0] / np.sqrt(20)
    up = recorded.loc[recorded["manoeuvre"] == "by-hand-07", ["accel_x", "accel_y", "accel_z"]]
    recorded.loc[up.index, up.columns] *= 1 + size / GIVEN.gravity
    _, fit, (finding,) = accelerometers_alone(recorded, imu)
    assert finding.manoeuvre == "by-hand-07" and finding.count == 1
    assert finding.size == pytest.approx(size, rel=0.2)
    assert list(fit.index[fit["reason"].fillna("") != ""]) == ["by-hand-07"]


def gyros_raise(blocks, imu):
    estimates = Estimates("gyroscope")
    return add_free_gyros(estimates, CampaignData(PLAN, {}, blocks, noise(imu), KNOWN))


@pytest.mark.parametrize("creeping", [1, 2])
def test_positions_that_creep_are_named_by_the_gyros_as_moved(imu, recorded, creeping):
    """By 1.6° in 20 s, 0.08°/s: only an appendix said that they are left out."""
    assert not gyros_raise(recorded, imu)
    names = ["by-hand-04", "by-hand-09"][:creeping]
    rates = np.radians(1.6) / 20 * np.array([0.6, 0.64, 0.48])
    crept = recorded.copy()
    channels = ["gyro_x", "gyro_y", "gyro_z"]
    crept.loc[crept["manoeuvre"].isin(names), channels] += imu.gyro @ rates
    (finding,) = gyros_raise(crept, imu)
    assert finding.cause == "moved_while_read" and finding.sensor == "gyro"
    assert finding.count == creeping and finding.severity == 1
    assert finding.manoeuvre in names and all(name in finding.sentence for name in names)
    assert finding.size == pytest.approx(np.abs(rates).max(), rel=0.15)


def test_positions_that_all_scatter_are_none_that_was_moved(imu):
    recorded = every_way(imu, 48)
    channels = ["accel_x", "accel_y", "accel_z"]
    scatter = 0.05 * np.random.default_rng(7).standard_normal((48, 3))
    assert not accelerometers_alone(
        recorded.assign(
            **dict(zip(channels, (recorded[channels] + scatter).T.to_numpy(), strict=True))
        ),
        imu,
    )[2]


def test_what_drifts_within_a_rest_by_hand_is_no_drift_between_rests(imu, recorded):
    """1 mg of x within each rest; the rests themselves agree."""
    size = 1e-3 * GIVEN.gravity

    def sigmas(drifts):
        estimates = Estimates("accelerometer")
        data = CampaignData(PLAN, {}, recorded, noise(imu, drifts), KNOWN)
        add_free_accelerometers(estimates, data)
        table = estimates.tables()["parameters"].set_index("parameter")["sigma"]
        return table[["bias_x", "bias_y", "bias_z"]].to_numpy(np.float64)

    drifting = {"accel_x": {"bias_instability": size, "random_walk": size}}
    np.testing.assert_array_equal(sigmas(None), sigmas(drifting))


@pytest.mark.parametrize(
    ("shares", "up", "told"),
    [
        (
            {2: 0.7, 8: -0.7},
            (0, 0, -1),
            "the rests do not tell the scale factor of z from the bias of z: add one with -z up",
        ),
        (
            {7: 1.0},
            (0, 1, 0),
            "too few rests have y up or down: add one with +y up and one with -y up",
        ),
        (
            {3: 0.6, 5: 0.5, 6: 0.5},
            (1, -1, 1),
            "the rests do not tell the angle between x and y, the angle between y and z from the"
            " bias of x: add one with +x, -y and +z all 35° above level",
        ),
    ],
)
def test_words(shares, up, told):
    along = np.zeros(9)
    for i, share in shares.items():
        along[i] = share
    assert in_words(Unobservable(along, np.array(up, float))) == told


def test_gyros_that_turned_are_not_said_to_have_hardly_turned(imu):
    """From +x up to +y up and back: about z, which was level; two attitudes are too few."""
    blocks = blocks_of(*handled(imu, TWENTY_FOUR[[0, 2, 0]], 20))
    table, _, _ = rows(add_free_gyros, "gyroscope", blocks, imu)
    undetermined = table["reason"].dropna()
    assert np.isnan(table.loc["scale_x", "value"])
    assert "hardly turned about x" in undetermined["scale_x"]
    assert "was turned about z while z was horizontal" in undetermined["scale_z"]
