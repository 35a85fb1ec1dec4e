"""`make design`: what is foreseen against an independent bound, plans, classes split, refusals."""

import re
from dataclasses import replace
from itertools import pairwise

import chain
import numpy as np
import pytest
from drawn_campaigns import densities, least, planned
from ruamel.yaml import YAML

from commands.design import __main__ as design
from commands.design.for_campaign import (
    FORESEEN_RIGHT,
    NAMES,
    Class,
    Splitting,
    reach,
    wanted_sigmas,
)
from commands.design.from_nothing import best, foreseen_of
from commands.design.printed import new_campaign, with_more
from commands.design.turntable import instrument, turntable
from commands.design.visits import Visit, items_of, plan_of, possible
from inertial.campaign.foreseen import Pace, foreseen, session_seconds, sigmas, stated_noise
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import known_of, manoeuvres_of
from inertial.effects import CATALOGUE
from inertial.tables.errors import Refusal

DATA = chain.ROOT / "data"
FEW = {"rests": (60.0, 180.0), "shares": (1.0, 0.25), "turning": (30.0,)}


@pytest.fixture(scope="module")
def cube():
    return turntable("cube", DATA)


@pytest.fixture(scope="module")
def imu():
    return instrument("stim300", DATA)


@pytest.fixture(scope="module")
def sources(imu, cube):
    return design.source_plans(imu, cube)


@pytest.mark.parametrize("plan", ["a", "b", "c"])
def test_foreseen_sigmas_are_the_bound(plan):
    """That of tests/bounds, which shares no code: blocks by its own physics, derivatives by steps.

    There a turn has 2 s at rest on both sides.
    """
    told = planned(plan)
    accel, gyro = densities("FSAS")[[0, 3]]
    noise = stated_noise({"accel": {"white_noise": accel}, "gyro": {"white_noise": gyro}})
    data = foreseen(manoeuvres_of(told.manoeuvres), Pace(3.0, 5.0), noise, known_of(told.known))
    np.testing.assert_allclose(sigmas(data), least(plan, "FSAS"), rtol=0.02)


def test_the_time_of_a_plan_is_that_of_its_parts():
    table = turntable("three-axis", DATA)  # 5 s still, 15 s for a change, 50 °/s²
    visits = [
        Visit((1.0, 0.0, 0.0), 60.0),
        Visit((0.0, 0.0, -1.0), 30.0, ((100.0, 2),)),
    ]
    plan = plan_of(items_of(visits, table), table)
    turn = 720 / 100 + 100 / 50
    assert session_seconds(plan, table.pace) == pytest.approx(60 + 15 + 30 + 2 * (turn + 2 * 5))


@pytest.mark.slow
def test_a_designed_plan_is_better_and_a_campaign(imu, cube, sources, tmp_path, monkeypatch):
    """In S3's time the mean variance is less than S3's; the file is what the stage plan reads."""
    monkeypatch.setattr("commands.design.from_nothing.possible", lambda t, r: possible(t, r, **FEW))
    s3 = sources["S3"]
    made = best(imu, cube, s3.seconds / 60, "A", s3.sigmas)
    assert made.seconds <= s3.seconds
    assert np.mean((made.sigmas / s3.sigmas) ** 2) < 0.9
    assert 0.9 < made.search.efficiency <= 1
    ups = [item["up"] for item in made.items if item["do"] == "rest" or item["degrees"] > 0]
    positions = list(dict.fromkeys((item["position"], str(item["up"])) for item in made.items))
    assert all(a[1] != b[1] for a, b in pairwise(positions)) and ups
    folder = tmp_path / "june"
    folder.mkdir()
    text = new_campaign("june", imu, cube, made.items, made.seconds / 60)
    (folder / "campaign.yaml").write_text(text, encoding="utf-8")
    (folder / "session.csv").write_text("a log\n")
    told = chain.run(folder, tmp_path / "derived", "plan")
    read = manoeuvres_of(told["plan/manoeuvres"])
    assert [m.name for m in read] == [m.name for m in made.data.plan]
    for one, other in zip(read, made.data.plan, strict=True):
        assert (one.position, one.do) == (other.position, other.do)
        assert one.seconds == pytest.approx(other.seconds)
        assert (one.angle, one.rate) == (pytest.approx(other.angle), pytest.approx(other.rate))
    # Foreseen of what the stage reads it is the same.
    again = foreseen(read, cube.pace, imu.noise, known_of(told["plan/known"]))
    np.testing.assert_allclose(sigmas(again), made.sigmas, rtol=2e-3)


@pytest.mark.slow
def test_a_class_is_split_in_a_fraction_of_the_time(imu):
    """S3's class of nonlinearities and acceleration, at 20 ppm/(°/s), by a manoeuvre that is found.

    A term with the rate and one with its square differ at a third rate only, one with acceleration
    where the axis points the other way.
    """
    table = turntable("three-axis", DATA)
    names = ("gyro_scale_quadratic", "gyro_scale_cubic", "gyro_scale_g_dependence")
    data = with_effect(design.source_plans(imu, table)["S3"].data, names[0], 2e-5 / np.radians(1))
    of = Class("", names, ())
    own = session_seconds(data.plan, table.pace)
    visits = possible(table, imu.max_rate, both=False, single=True, **FEW)
    added = Splitting(data, of, table).best(visits, own / 2)
    assert added.before < 0.6
    assert added.after >= FORESEEN_RIGHT
    assert 0 < added.seconds <= own / 4
    rates = {item["rate_deg_s"] for item in added.items if item["do"] == "turn"}
    assert rates - {6.0, 12.0}
    # What cannot differ is not distinguished by anything.
    blind = [visit for visit in visits if not visit.turns]
    none = Splitting(data, of, table).best(blind, own / 2)
    assert none.after < 0.6


def with_effect(data, name, size):
    """A campaign with the readings of an effect in its blocks, to first order."""
    campaign, effect = campaign_of(data), CATALOGUE[name]
    sensitivities = campaign.sensitivities("gyro", [effect])
    blocks = data.blocks.copy()
    gyros = ["gyro_x", "gyro_y", "gyro_z"]
    for turn, response in zip(
        campaign.inputs.usable, sensitivities[len(campaign.static_motions) :], strict=True
    ):
        rows = (blocks["manoeuvre"] == turn.plan.name) & ~blocks["phase"].str.startswith("rest")
        blocks.loc[rows, gyros] += response.values @ np.full(3, size)
    return replace(data, blocks=blocks)


@pytest.mark.slow
def test_a_wanted_sigma_is_reached(imu, cube, sources):
    data = sources["S0"].data
    wanted = wanted_sigmas(["gyroscope/scale=1.2e-5"])
    assert [NAMES[i] for i in np.flatnonzero(np.isfinite(wanted))] == [
        f"gyroscope/scale_{axis}" for axis in "xyz"
    ]
    reached = reach(data, cube, possible(cube, imu.max_rate, **FEW), wanted)
    assert np.any(reached.before > wanted) and np.all(reached.after <= wanted)
    assert 0 < reached.seconds < 1500
    assert not reach(data, cube, [], 10 * reached.before).items


def test_what_is_added_to_a_campaign_file(cube):
    items = items_of([Visit((0.0, 0.0, 1.0), 60.0)], cube, "next")
    old = (chain.ROOT / "tests/campaigns/s0.yaml").read_text(encoding="utf-8")
    text, log = with_more(old, items, "", 1.0)
    before, after = (YAML(typ="safe").load(each) for each in (old, text))
    assert after["plan"][:-1] == before["plan"]
    assert after["plan"][-1] == items[0] | {"log": log}
    assert log not in {item.get("log") for item in before["plan"]}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--table", "round"], r"'round'[\s\S]*three-axis, two-axis, cube"),
        (["--table", "cube", "--instrument", "none"], r"'none'[\s\S]*imar-fsas"),
        (["--table", "cube", "--instrument", "xw-gi7681"], "angle_random_walk_deg_sqrt_h"),
        (["--table", "cube", "--instrument", "stim300", "--minutes", "x"], "1 to 1000 minutes"),
        (["--table", "cube", "--campaign", "none"], r"none/\w+/\w+\.parquet"),
    ],
)
def test_what_cannot_be_designed_is_refused(arguments, said, tmp_path, capsys):
    for name in ("tables.yaml", "instruments.yaml"):
        (tmp_path / name).write_text((DATA / name).read_text(encoding="utf-8"), encoding="utf-8")
    assert design.main([*arguments, "--data", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("design: ")
    assert re.search(said, error)
    with pytest.raises(Refusal, match="WANT"):
        wanted_sigmas(["gyroscope/speed=1"])


def test_a_table_that_turns_nothing_over_leaves_parameters_undetermined(imu):
    table = replace(turntable("cube", DATA), ups=np.array([[0.0, 0.0, 1.0]]))
    visits = [Visit((0.0, 0.0, 1.0), 60.0, ((100.0, 8),))]
    told = foreseen_of(items_of(visits, table), table, imu.noise)
    assert np.isinf(told.sigmas[NAMES.index("accelerometer/bias_z")])
    assert np.isfinite(told.sigmas[NAMES.index("gyroscope/scale_z")])
