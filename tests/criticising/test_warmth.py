"""Means at temperatures: a law is found with its numbers, a knee is no law, noise is silent."""

from collections import defaultdict

import chain
import numpy as np
import pandas as pd
import pytest
from means_at_temperatures import ICE_POINT, RATE, blocks, manoeuvre, temperatures

from inertial import tables
from inertial.estimation.regression import curve_of, knee_of
from stages.criticism.temperature_findings import temperature_rows

LEVEL = 0.01
MIDDLE = ICE_POINT + 33  # about which the numbers of the law are told
STILL = manoeuvre("still")
TURN = manoeuvre("turn", "turn")


def said(made: pd.DataFrame, *plan) -> dict[str, dict]:
    """The findings, with members and parameters, by manoeuvre and what is swept."""
    rows = defaultdict(list)
    for table, row in temperature_rows(made, plan or [STILL], LEVEL, ""):
        rows[table].append(row)
    names = [column.name for column in tables.EFFECT_FINDINGS.columns]
    tables.EFFECT_FINDINGS.arrow(pd.DataFrame(rows["findings"], columns=names))
    found = {}
    for row in rows["findings"]:
        own = {
            table: [one for one in rows[table] if one["finding"] == row["id"]]
            for table in ("members", "effects")
        }
        found[row["id"].removeprefix("criticism/temperature/")] = {
            **row,
            "members": [one["effect"] for one in own["members"]],
            "parameters": {
                one["parameter"]: (one["value"], one["sigma"]) for one in own["effects"]
            },
        }
    assert len(found) == len(rows["findings"])
    return found


def at_rest(seed: int, **changes) -> pd.DataFrame:
    """Each change is a function of K above the middle."""
    at = temperatures(seed)
    return blocks("still", seed, at, {name: law(at - MIDDLE) for name, law in changes.items()})


def number(row: dict, name: str) -> tuple[float, float]:
    return row["parameters"][name]


def test_what_does_not_go_with_the_temperature_is_silent():
    for seed in range(20):
        at = temperatures(seed)
        still = blocks("still", seed, at, {})
        turn = blocks("turn", seed, at, {"gyro_z": np.full(len(at), RATE * 0.995)})
        assert not said(pd.concat([still, turn]), STILL, TURN), seed


def test_the_chances_are_true():
    """Of noise alone; 600 draws tell 5 % to 0.9 %."""
    rng = np.random.default_rng(3)
    at = temperatures(3)
    curves = [curve_of(at, rng.standard_normal(len(at))) for _ in range(600)]
    for below in (0.05, 0.5):
        scatter = 4 * np.sqrt(below * (1 - below) / len(curves))
        for degree in (1, 2, 3):
            chances = [curve.p_value(range(degree, degree + 1)) for curve in curves]
            assert np.mean(np.array(chances) < below) == pytest.approx(below, abs=scatter)
    beyond = np.array([curve.misfit_p_value() for curve in curves])
    scatter = 4 * np.sqrt(0.05 * 0.95 / len(curves))
    assert np.mean(beyond < 0.05) == pytest.approx(0.05, abs=scatter)


def test_a_straight_line_of_a_gyro_is_found_with_its_number():
    pulls = []
    for seed in range(8):
        found = said(at_rest(seed, gyro_y=lambda t: -4e-5 * t))
        (row,) = found.values()
        assert row["verdict"] == "found" and row["members"] == ["gyro_bias_temperature"]
        assert row["axis"] == "y" and row["degrees"] == 1 and row["p_value"] < 1e-6
        assert "along a straight line" in row["sentence"]
        value, sigma = number(row, "k1_y")
        pulls.append((value + 4e-5) / sigma)
    assert np.abs(pulls).max() < 3.5 and 0.4 < np.std(pulls) < 1.9


def test_a_parabola_is_of_the_second_degree():
    bent = 3e-5  # m/s²/K²; over 32 K that is 0.03 m/s²
    (row,) = said(at_rest(4, accel_x=lambda t: bent * t**2)).values()
    assert row["cause"] == "accel_bias_temperature" and row["degrees"] == 2
    assert "along a parabola" in row["sentence"] and "a straight line would" in row["sentence"]
    value, sigma = number(row, "k2_x")
    assert abs(value - bent) < 3 * sigma < 0.4 * bent


def test_a_knee_is_no_law_and_is_found():
    knee, slope = ICE_POINT + 25, -5e-3
    (row,) = said(at_rest(5, accel_z=lambda t: slope * np.minimum(t + MIDDLE - knee, 0))).values()
    assert row["verdict"] == row["cause"] == "unknown_structure" and row["axis"] == "z"
    assert "not along a straight line nor a cubic" in row["sentence"]
    assert "The data are no more than consistent with" in row["sentence"]
    for name, true in (("knee_z", knee), ("below_z", slope), ("above_z", 0.0)):
        value, sigma = number(row, name)
        assert abs(value - true) < 3.5 * sigma, name
    assert number(row, "knee_z")[1] < 3  # K
    # It is not taken for a law of the effects that it is consistent with.
    assert set(row["members"]) == {"accel_bias_temperature", "accel_scale_temperature"}


def test_the_interval_of_a_knee_holds_it():
    rng = np.random.default_rng(6)
    at = temperatures(6)
    line = -5e-3 * np.minimum(at - 298, 0)
    knees = [knee_of(at, line + 3e-3 * rng.standard_normal(len(at))) for _ in range(60)]
    inside = [knee.between[0] <= 298 <= knee.between[1] for knee in knees]
    assert sum(inside) > 48  # of 57 expected


@pytest.mark.parametrize(
    ("channel", "change", "able"),
    [
        ("accel_x", 5e-2, ["accel_bias_temperature", "table_tilt"]),  # 0.3° of tilt would do it
        ("accel_x", 1.0, ["accel_bias_temperature"]),  # 6° of the table are not thought of
        ("accel_z", 5e-2, ["accel_bias_temperature", "accel_scale_temperature"]),
    ],
)
def test_an_acceleration_is_what_its_attitude_allows(channel, change, able):
    (row,) = said(at_rest(7, **{channel: lambda t: change / 64 * t})).values()
    assert row["members"] == able
    assert row["verdict"] == ("one_of_class" if len(able) > 1 else "found")
    # Along the vertical a tilt that small does nothing, and the sentence says so.
    assert ("No tilt changes z" in row["sentence"]) == (channel == "accel_z")


def test_of_a_turn_the_reading_at_rest_is_taken_off():
    at = temperatures(8)
    bias, scale = 5e-5 * (at - MIDDLE), 3e-5 * (at - MIDDLE)
    still = blocks("still", 8, at, {"gyro_z": bias})
    turn = blocks("turn", 8, at[3:-3], {"gyro_z": (bias + RATE * (1 + scale))[3:-3]})
    found = said(pd.concat([still, turn]), STILL, TURN)
    assert set(found) == {"still/gyro", "turn/scale"}
    row = found["turn/scale"]
    assert row["verdict"] == "one_of_class" and row["unit"] == "1"
    assert row["members"] == ["gyro_scale_temperature", "table_speed_error"]
    value, sigma = number(row, "k1_z")
    assert abs(value - 3e-5) < 3.5 * sigma < 1.5e-5
    (alone,) = said(turn, TURN).values()
    assert "gyro_bias_temperature" in alone["members"]


def test_where_time_or_samples_were_recorded_it_is_silent():
    made = at_rest(9, gyro_y=lambda t: -4e-5 * t)
    assert said(made)
    assert not said(made.assign(time=np.arange(len(made)) * 1.0))
    assert not said(made.assign(count=1.0))
    assert not said(tables.BLOCKS.empty())
    assert not said(made.assign(temperature=ICE_POINT + 0.05 * np.arange(len(made))))  # 1.4 K


def test_a_mean_of_a_few_samples_does_not_count():
    made = at_rest(10, gyro_y=lambda t: -4e-5 * t)
    made.loc[made.index[-1], ["gyro_y", "count"]] = (0.5, 3.0)
    (row,) = said(made).values()
    assert row["degrees"] == 1 and "Omitted: 1 mean of fewer than 200 samples" in row["sentence"]


def test_a_log_of_means_goes_through_the_chain(tmp_path):
    """Each record is a block; what criticism names does not stop the extension."""
    folder = tmp_path / "means"
    folder.mkdir()
    campaign = chain.ROOT / "tests/campaigns/hipnuc.yaml"
    (folder / "campaign.yaml").write_text(campaign.read_text(encoding="utf-8"))
    at = temperatures(11)
    rest = blocks("still", 11, at, {"gyro_y": -4e-5 * (at - MIDDLE)})
    scale = 1 + 3e-5 * (at - MIDDLE)
    lines = [
        f"BIN_DATA: {i}, {row.temperature - ICE_POINT:.2f}, 20000, 9000, {row.accel_x:.5f},"
        f" {row.accel_y:.5f}, {row.accel_z:.5f}, {row.gyro_x:.7f}, {row.gyro_y:.7f},"
        f" {row.gyro_z:.7f}, {np.degrees(row.gyro_z) - 50 * scale[i]:.5f}"
        for i, row in enumerate(rest.itertuples())
    ]
    (folder / "test.log").write_text("\n".join(lines) + "\n")
    results = chain.run(folder, tmp_path / "derived", "extension", chain.BESIDE)
    still = results["segment/blocks"].query("manoeuvre == 'still'")
    assert len(still) == len(at) and (still["count"] == 20000).all()
    causes = results["criticism/findings"].set_index("cause")
    assert list(causes["verdict"]) == ["found", "one_of_class"]
    assert set(causes.index) == {"gyro_bias_temperature", "gyro_scale_temperature"}
    assert results["extension/parameters"].empty
