"""`make new`: plans to record by, which the stage plan takes as soon as the logs are there."""

import chain
import numpy as np
import pytest
import yaml

from commands.new import PLANS, main
from inertial.campaign.references import NAMELESS
from inertial.estimation.triad import linear_names
from inertial.tables.campaign_files import logs_of


def planned(plan: str, tmp_path) -> chain.Results:
    """The tables of plan for a new plan, with logs of any content."""
    assert main(["--plan", plan, "--name", "june", "--data", str(tmp_path / "data")]) == 0
    folder = tmp_path / "data/raw/june"
    for log in logs_of(folder / "campaign.yaml"):
        (folder / log).write_text("a log\n")
    return chain.run(folder, tmp_path / "derived", "plan")


@pytest.mark.parametrize(
    ("plan", "manoeuvres"),
    [("six-position", 12), ("turn-stop", 24), ("rate-table", 30 + 2 * 36), ("by-hand", 1)],
)
def test_a_new_plan_is_a_plan(plan, manoeuvres, tmp_path):
    assert len(planned(plan, tmp_path)["plan/manoeuvres"]) == manoeuvres
    assert plan in PLANS and len(PLANS) == 4


@pytest.mark.parametrize("plan", PLANS)
def test_the_table_of_a_new_plan_has_no_name(plan, tmp_path):
    assert set(planned(plan, tmp_path)["plan/campaign"]["table"]) <= set(NAMELESS)


@pytest.mark.parametrize("plan", ["six-position", "turn-stop"])
def test_every_axis_points_up_and_down_and_is_turned_about_both_ways(plan, tmp_path):
    rows = planned(plan, tmp_path)["plan/manoeuvres"]
    rests, turns = rows[rows["do"] == "rest"], rows[rows["do"] == "turn"]
    ups = {tuple(up) for up in rests[["up_x", "up_y", "up_z"]].to_numpy()}
    assert ups == {tuple(sign * axis) for axis in np.eye(3) for sign in (1.0, -1.0)}
    about = turns[["about_x", "about_y", "about_z"]].to_numpy()
    assert np.linalg.matrix_rank(about) == 3
    np.testing.assert_allclose(turns["angle"].abs(), 2 * np.pi)
    assert turns["angle"].sum() == pytest.approx(0)


def test_a_rate_table_turns_each_axis_at_rates_of_both_signs(tmp_path):
    turns = planned("rate-table", tmp_path)["plan/manoeuvres"].query("do == 'turn'")
    for _position, rates in turns.groupby("position")["rate"]:
        assert len(rates) == 10 and sorted(rates) == pytest.approx(sorted(-rates))
    assert turns["position"].nunique() == 3


@pytest.mark.slow
def test_a_session_by_the_plan_of_a_rate_table_determines_all_parameters():
    """With a mount for each axis no mount determined them, and nothing was simulated."""
    document = chain.demo(seed=5, effects={}, faults=[])
    steady = {"seconds": 60, "accel_deg_s2": 20}
    plan = yaml.safe_load(PLANS["rate-table"].read_text())["plan"]
    document["campaign"]["plan"] = [m | steady if m["do"] == "turn" else m for m in plan]
    document["handling"] |= {"step": {"rate_deg_s": 30, "accel_deg_s2": 40}}
    document["receiver"]["rate_hz"] = 20
    tables = chain.in_memory_of(document, "gyroscope", ())
    truth = document["truth"]
    for stage, sensor, bias in (
        ("accelerometer", "accelerometer", "bias_m_s2"),
        ("gyroscope", "gyro", "bias_rad_s"),
    ):
        found = tables[f"{stage}/parameters"].query("method == 'joint'").set_index("parameter")
        matrix = np.array(truth[sensor]["matrix"]) - np.eye(3)
        told = dict(zip(linear_names(), [*matrix.ravel(), *truth[sensor][bias]], strict=True))
        for name, value in told.items():
            assert abs(found["value"][name] - value) < 4.5 * found["sigma"][name], name


def test_by_hand_no_attitude_need_be_known(tmp_path):
    (row,) = planned("by-hand", tmp_path)["plan/manoeuvres"].itertuples()
    assert row.do == "positions" and row.seconds == 3


@pytest.mark.parametrize(
    ("arguments", "found"),
    [
        (
            ["--plan", "six", "--name", "june"],
            "one of by-hand, rate-table, six-position",
        ),
        (["--plan", "by-hand", "--name", "ä"], "small letters"),
        (["--plan", "by-hand", "--name", "there"], "there is a campaign of this name"),
        (["--plan", "by-hand", "--name", "demo"], "there is a campaign of this name"),
    ],
)
def test_what_is_asked_wrongly_is_said(arguments, found, tmp_path, capsys):
    data = tmp_path / "data"
    (data / "raw/there").mkdir(parents=True)
    (data / "simulated").mkdir()
    (data / "simulated/demo.yaml").touch()
    assert main([*arguments, "--data", str(data)]) == 2
    assert found in capsys.readouterr().err
    assert not list(data.glob("raw/*/*"))
