"""Repairs: what is wrong as a whole is set right, named once, and moves no parameter."""

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from math import degrees
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

import laboratory
from inertial.estimation.triad import linear_names
from inertial.tables.errors import Refusal
from stages.segment.recording_explanations import _rivals

sys.path.insert(0, str(Path(__file__).parent / "hidden"))
import hidden_plans

Document = dict[str, Any]
Fault = dict[str, dict[str, Any]]
Edit = Callable[[Document], None]

MAX_PULL = 4.5  # sigma: 24 parameters of a normal distribution stay within it but once in 6000


def flip(sensor: str, axis: str, log: str = "all") -> Fault:
    return {"flip": {"log": log, "sensor": sensor, "axis": axis}}


def swap(sensor: str, axes: str, log: str = "all") -> Fault:
    return {"swap": {"log": log, "sensor": sensor, "axes": list(axes)}}


def exchange(*names: str) -> Fault:
    return {"exchange": {"logs": [f"{name}.asc" for name in names]}}


def faults(*all_of_them: Fault) -> Edit:
    return lambda document: document.update(faults=list(all_of_them))


def misstated(**said: Any) -> Edit:
    return lambda document: document.update(misstated={**document.get("misstated", {}), **said})


def all_turns(change: Callable[[Document], Document]) -> Edit:
    """The plan misstates all of its turns."""

    def edit(document: Document) -> None:
        plan = document["campaign"]["plan"]
        misstated(plan={one["id"]: change(one) for one in plan if one["do"] == "turn"})(document)

    return edit


def count_size(sensor: str, key: str, factor: float) -> Edit:
    """The campaign names counts that are `factor` times as large as those of the IMU."""

    def edit(document: Document) -> None:
        receiver = document["receiver"]
        counts = {
            "gyro": {"count_rad": receiver["gyro_count_rad"]},
            "accelerometer": {"count_m_s": receiver["accelerometer_count_m_s"]},
        }
        document["campaign"]["instrument"] = {
            "name": "of 100 Hz",
            "rate_hz": 100,
            "axes": ["z", "-y", "x"],
            "format": {"kind": "rawimus"},
            **counts,
        }
        misstated(instrument={sensor: {key: counts[sensor][key] * factor}})(document)

    return edit


def in_one_log(document: Document) -> None:
    """All manoeuvres one after another, and the changes of position between them, 10 s each."""
    for one in document["campaign"]["plan"]:
        del one["log"]
    document["campaign"]["log"] = "session.asc"
    document["handling"]["change_s"] = 10


def noisy(document: Document) -> None:
    """Gyros that do not see the earth turn: 3 °/√h is 40 °/h over a rest of 20 s."""
    document["noise"]["angle_random_walk_deg_sqrt_h"] = 3.0


def recorded(*edits: Edit, until: str = "gyroscope") -> chain.Results:
    document = chain.short()
    for edit in edits:
        edit(document)
    return chain.in_memory_of(document, until)


def findings(results: chain.Results) -> pd.DataFrame:
    return pd.concat([results["quality/findings"], results["segment/findings"]])


def repairs(results: chain.Results) -> pd.DataFrame:
    return pd.concat([results["plan/repairs"], results["segment/repairs"]]).set_index("id")


def pulls(results: chain.Results) -> np.ndarray:
    """The 24 parameters less those of the laboratory, in sigma."""
    truth = chain.short()["truth"]
    made = []
    for stage, sensor, unit in (("accelerometer",) * 2 + ("m_s2",), ("gyroscope", "gyro", "rad_s")):
        matrix, bias = np.array(truth[sensor]["matrix"]), truth[sensor][f"bias_{unit}"]
        true = {f"bias_{axis}": bias[i] for i, axis in enumerate("xyz")}
        for i, axis in enumerate("xyz"):
            for j, other in enumerate("xyz"):
                name = f"scale_{axis}" if i == j else f"cross_{axis}{other}"
                true[name] = matrix[i, j] - (i == j)
        solved = results.parameters(stage).reindex(linear_names())
        made.append((solved["value"] - pd.Series(true)) / solved["sigma"])
    return np.concatenate(made)


SET_RIGHT = {
    "the y gyro reads its negative": ([faults(flip("gyro", "y"))], "signs/gyro", "sign_flip"),
    "x and y accelerometers exchanged": (
        [faults(swap("accelerometer", "xy"))],
        "axes/accel",
        "axis_swap",
    ),
    "all accelerometers reversed": (
        [faults(*(flip("accelerometer", axis) for axis in "xyz"))],
        "signs/accel",
        "sign_flip",
    ),
    "all gyros reversed": ([faults(*(flip("gyro", a) for a in "xyz"))], "signs/gyro", "sign_flip"),
    "accelerometers exchanged in one log": (
        [faults(swap("accelerometer", "xy", "x-up.asc"))],
        "axes/accel/x-up.asc",
        "axis_swap",
    ),
    "degrees read as radians": (
        [count_size("gyro", "count_rad", degrees(1))],
        "count_size/gyro",
        "wrong_scale_factor",
    ),
    "degrees read as radians in one log": (
        [count_size("gyro", "count_rad", degrees(1)), in_one_log],
        "count_size/gyro",
        "wrong_scale_factor",
    ),
    "another full scale of the gyros": (
        [count_size("gyro", "count_rad", 16)],
        "count_size/gyro",
        "wrong_scale_factor",
    ),
    "m/s² read as g": (
        [count_size("accelerometer", "count_m_s", 9.80665)],
        "count_size/accel",
        "wrong_scale_factor",
    ),
    "two logs under each other's names": (
        [faults(exchange("x-up", "y-up"))],
        "exchanged_manoeuvres/x-up/y-up",
        "manoeuvre_swapped",
    ),
    "a turn and its opposite exchanged": (
        [faults(exchange("z-forward", "z-backward"))],
        "exchanged_manoeuvres/z-backward/z-forward",
        "manoeuvre_swapped",
    ),
    "the table counts the other way": (
        [all_turns(lambda turn: {"degrees": -turn["degrees"]})],
        "sense_of_table",
        "wrong_direction",
    ),
    "half the rate is stated": (
        [all_turns(lambda turn: {"rate_deg_s": 30})],
        "stated_rate",
        "wrong_rate",
    ),
    "the unit g for gravity": (
        [misstated(site={"gravity_m_s2": 9.8066})],
        "gravity",
        "gravity_error",
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("edits", "repair", "cause"),
    [pytest.param(*case, id=name) for name, case in SET_RIGHT.items()],
)
def test_what_is_wrong_as_a_whole_is_set_right_and_named_once(edits, repair, cause):
    results = recorded(*edits)
    assert results["segment/performed"]["complete"].all()
    of_all = pulls(results)
    assert len(of_all) == 24 and np.isfinite(of_all).all()
    assert np.abs(of_all).max() < MAX_PULL
    (finding,) = findings(results).to_dict("records")
    assert finding["cause"] == cause
    (row,) = repairs(results).reset_index().to_dict("records")
    assert (row["id"], row["state"], row["finding"]) == (repair, "applied", finding["id"])
    assert row["condition"] and row["sentence"]
    if repair != "gravity":
        assert row["fitting_before"] < row["fitting_after"] == row["observations"]


@pytest.mark.slow
def test_two_turns_the_other_way_may_be_two_in_the_other_order():
    """Within one log the first of them fits the place of the second: one alone seems lost."""

    def y_turns(document: Document) -> None:
        turns = [one for one in document["campaign"]["plan"] if one["id"].startswith("y-")]
        other = {one["id"]: {"degrees": -one["degrees"]} for one in turns if one["do"] == "turn"}
        assert len(other) == 2
        misstated(plan=other)(document)

    results = recorded(in_one_log, y_turns)
    assert np.abs(pulls(results)).max() < MAX_PULL
    (row,) = repairs(results).reset_index().to_dict("records")
    assert (row["id"], row["state"]) == ("sense_of_table/y", "applied")
    assert "or they were done in the other order, which gives the same" in row["condition"]


def planned_other_way_up(*names: str) -> Edit:
    """The plan has manoeuvres upside down, so that a table turns about the other direction."""

    def edit(document: Document) -> None:
        plan = {one["id"]: one for one in document["campaign"]["plan"]}
        ups = {name: plan[name]["up"].translate(str.maketrans("+-", "-+")) for name in names}
        misstated(plan={name: {"up": up} for name, up in ups.items()})(document)

    return edit


@pytest.mark.slow
@pytest.mark.parametrize("rests", [[], ["y-up", "y-down"]])
def test_turns_that_stood_the_other_way_up_are_taken_so(rests):
    """And no axis of both sensors is reversed, which would be left-handed: gravity shows it."""
    turns = ["y-forward", "y-backward"]
    results = recorded(in_one_log, planned_other_way_up(*turns, *rests))
    assert np.abs(pulls(results)).max() < MAX_PULL
    told = repairs(results)
    expected = ["other_way_up/y"] + (["exchanged_manoeuvres/y-down/y-up"] if rests else [])
    assert sorted(told.index) == sorted(expected) and set(told["state"]) == {"applied"}
    condition = "in y-forward, y-backward the IMU stood the other way up than planned"
    assert told.loc["other_way_up/y", "condition"] == condition
    plan = results["segment/manoeuvres"].set_index("manoeuvre")
    assert plan.loc["y-forward", ["up_y", "about_y"]].tolist() == [1, 1]


@pytest.mark.slow
def test_where_gravity_does_not_turn_a_reversed_axis_may_be_another_attitude():
    results = recorded(faults(flip("gyro", "y"), flip("accelerometer", "y")))
    told = repairs(results)
    assert set(told.index) == {"signs/accel", "signs/gyro"}
    both = "or the IMU stood the other way up than planned wherever this axis was vertical"
    assert all(both in condition for condition in told["condition"])


def y_turns_exchanged(of_one_log: bool) -> Edit:
    """A turn of 360° and one of 1080° the same way, recorded in each other's place."""

    def edit(document: Document) -> None:
        turns = {one["id"]: one for one in document["campaign"]["plan"]}
        turns["y-backward"]["degrees"] = 1080
        if not of_one_log:
            return faults(exchange("y-forward", "y-backward"))(document)
        turns["y-backward"]["degrees"], turns["y-forward"]["degrees"] = 360, 1080
        misstated(plan={"y-forward": {"degrees": 360}, "y-backward": {"degrees": 1080}})(document)

    return edit


@pytest.mark.parametrize("of_one_log", [True, False])
def test_two_turns_of_other_angles_one_way_are_exchanged(of_one_log):
    edits = [in_one_log] if of_one_log else []
    results = recorded(*edits, y_turns_exchanged(of_one_log))
    (row,) = repairs(results).reset_index().to_dict("records")
    assert (row["id"], row["state"]) == ("exchanged_manoeuvres/y-backward/y-forward", "applied")
    (finding,) = findings(results).to_dict("records")
    assert finding["cause"] == "manoeuvre_swapped"
    assert results["segment/performed"]["complete"].all()
    assert np.abs(pulls(results)).max() < MAX_PULL


@cache
def spans_of_session() -> pd.DataFrame:
    """When each manoeuvre of one log begins and ends, its rests with it."""
    segments = recorded(in_one_log, until="segment")["segment/segments"]
    return segments.groupby("manoeuvre").agg({"from_s": "min", "to_s": "max"})


def spans_late(late: float) -> Edit:
    """The plan states spans, by a clock that is ahead of that of the log."""
    spans = {name: {"span": [a + late, b + late]} for name, a, b in spans_of_session().itertuples()}
    return misstated(plan=spans)


@pytest.mark.slow
@pytest.mark.parametrize("late", [25.0, -8.0, 3000.0])
def test_spans_by_another_clock_are_moved_and_asked_for(late):
    results = recorded(in_one_log, spans_late(late))
    assert np.abs(pulls(results)).max() < MAX_PULL
    (finding,) = findings(results).to_dict("records")
    assert (finding["cause"], finding["log"]) == ("wrong_spans", "session.asc")
    assert finding["size"] == pytest.approx(late, abs=2.0)
    assert list(repairs(results)["state"]) == ["applied"]
    assert results["segment/performed"]["complete"].all()


def test_spans_by_the_clock_of_the_log_stay_where_they_are():
    results = recorded(in_one_log, spans_late(0.0), until="segment")
    assert repairs(results).empty and findings(results).empty


@pytest.mark.slow
def test_two_causes_are_two_repairs():
    wrong = [faults(flip("gyro", "y")), count_size("gyro", "count_rad", degrees(1))]
    results = recorded(*wrong)
    assert np.abs(pulls(results)).max() < MAX_PULL
    assert sorted(repairs(results).index) == ["count_size/gyro", "signs/gyro"]
    assert sorted(findings(results)["cause"]) == ["sign_flip", "wrong_scale_factor"]


@pytest.mark.slow
def test_gravity_of_the_place_has_the_sigma_of_the_field():
    results = recorded(misstated(site={"gravity_m_s2": 9.8066}), until="accelerometer")
    gravity = results["plan/known"].set_index("quantity").loc["gravity"]
    # WGS 84 at 30.5278° and 24 m; 50 mGal.
    assert gravity["value"] == pytest.approx(9.79359, abs=1e-5)
    assert gravity["sigma"] == pytest.approx(5e-4)
    sigma = results.parameters("accelerometer").loc["scale_x", "sigma"]
    assert sigma == pytest.approx(5e-4 / 9.79359, rel=0.05)
    row = repairs(results).loc["gravity"]
    assert row["stated"] == 9.8066
    assert "latitude of 45.5°" in row["condition"]


# ---- where others explain as much


@pytest.mark.slow
@pytest.mark.parametrize(
    "edits",
    [
        [all_turns(lambda turn: {"degrees": -turn["degrees"]})],
        [faults(*(flip("gyro", axis) for axis in "xyz"))],
    ],
)
def test_gyros_that_do_not_see_the_earth_leave_two_explanations(edits):
    results = recorded(noisy, *edits)
    told = repairs(results)
    assert set(told.index) == {"signs/gyro", "sense_of_table"}
    assert (told["state"] == "rival").all()
    assert results["segment/channel_repairs"].empty
    (finding,) = findings(results).to_dict("records")
    assert (told["finding"] == finding["id"]).all()
    assert "the table counts all its turns the other way" in finding["sentence"]
    assert (
        not results["segment/performed"].query("manoeuvre.str.contains('ward')")["complete"].any()
    )
    assert (
        results.parameters("gyroscope")["value"].drop(["bias_x", "bias_y", "bias_z"]).isna().all()
    )


@pytest.mark.slow
def test_the_laboratory_decides_between_two_explanations():
    reversed_ = faults(*(flip("gyro", axis) for axis in "xyz"))
    for repair, way in (("signs/gyro", 1), ("sense_of_table", -1)):
        results = recorded(noisy, reversed_, misstated(accept=[repair]))
        told = repairs(results)
        assert list(told["state"]) == ["confirmed"]
        assert list(told.index) == [repair]
        assert results["segment/performed"]["complete"].all()
        solved = results.parameters("gyroscope")
        # Read the other way, the bias comes out with the other sign.
        true = way * np.array(chain.short()["truth"]["gyro"]["bias_rad_s"])
        off = solved.loc[["bias_x", "bias_y", "bias_z"], "value"] - true
        assert (np.abs(off) < MAX_PULL * solved.loc[off.index, "sigma"]).all()


@pytest.mark.slow
def test_one_reversed_axis_may_be_two_exchanged_logs():
    told = repairs(recorded(noisy, faults(flip("gyro", "y")), until="segment"))
    assert set(told.index) == {"signs/gyro", "exchanged_manoeuvres/y-backward/y-forward"}
    assert (told["state"] == "rival").all()


@pytest.mark.slow
def test_both_triads_turned_alike_may_be_the_mounting():
    both = [flip(sensor, axis) for sensor in ("accelerometer", "gyro") for axis in "xy"]
    told = repairs(recorded(faults(*both), until="segment"))
    assert (told["state"] == "rival").all()
    assert told["condition"].str.contains("may be mounted turned").all()


# ---- what only looks like it


@pytest.mark.parametrize(
    "axis", [0, *(pytest.param(axis, marks=pytest.mark.slow) for axis in (1, 2))]
)
def test_a_large_scale_error_of_a_gyro_is_no_count_size(axis):
    def off(document: Document) -> None:
        document["truth"]["gyro"]["matrix"][axis][axis] = 1.235

    results = recorded(off, until="segment")
    assert repairs(results).empty
    assert results["segment/channel_repairs"].empty


def test_large_scale_errors_of_all_gyros_are_no_count_size():
    def off(document: Document) -> None:
        for i in range(3):
            document["truth"]["gyro"]["matrix"][i][i] = 1.235

    results = recorded(off, until="segment")
    assert repairs(results).empty
    assert list(findings(results)["cause"]) == ["wrong_scale_factor"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "bias",
    [
        *([6.4, 0, 0], [-6.4, 6.4, 6.4]),
        [0, 0, 6.4],
        [9.8, 0, 0],
    ],
)
def test_a_large_bias_of_an_accelerometer_is_no_count_size(bias):
    def off(document: Document) -> None:
        document["truth"]["accelerometer"]["bias_m_s2"] = bias

    assert "count_size/accel" not in repairs(recorded(off, until="segment")).index


def test_an_impact_reverses_nothing():
    knock = {"log": "x-up.asc", "line": 700, "peak_m_s2": 30.0, "peak_rad_s": 2.0}
    results = recorded(
        faults({"knock": knock | {"frequency_hz": 12, "decay_s": 0.4}}), until="segment"
    )
    assert repairs(results).empty
    assert not {"sign_flip", "axis_swap"} & set(findings(results)["cause"])


# ---- the settings, and the campaign file


@pytest.fixture
def refused(monkeypatch):
    for stage in ("plan", "segment"):
        monkeypatch.setitem(chain.SETTINGS, stage, {**chain.SETTINGS[stage], "repairs": "refuse"})


def test_refused_repairs_leave_the_recording_as_it_is(refused):
    wrong = [faults(flip("gyro", "y")), misstated(site={"gravity_m_s2": 9.8066})]
    results = recorded(*wrong, until="segment")
    told = repairs(results)
    assert set(told.index) == {"gravity", "signs/gyro"}
    assert (told["state"] == "refused").all()
    assert results["segment/channel_repairs"].empty
    assert results["plan/known"].set_index("quantity").loc["gravity", "value"] == 9.8066
    done = results["segment/performed"].set_index("manoeuvre")
    assert not done.loc[["y-forward", "y-backward"], "complete"].any()
    assert sorted(findings(results)["cause"]) == ["gravity_error", "sign_flip"]


@pytest.mark.slow
def test_refused_exchanges_and_senses_are_left_out(refused):
    results = recorded(faults(exchange("x-up", "y-up")), until="segment")
    done = results["segment/performed"].set_index("manoeuvre")["found"]
    assert list(done.index[~done]) == ["x-up", "y-up"]
    edit = all_turns(lambda turn: {"degrees": -turn["degrees"]})
    results = recorded(edit, until="segment")
    assert dict(repairs(results)["state"]) == {"sense_of_table": "refused"}
    done = results["segment/performed"].set_index("manoeuvre")["complete"]
    assert not done[done.index.str.contains("ward")].any()


def test_the_campaign_file_confirms_a_repair():
    wrong = [faults(flip("gyro", "y")), misstated(site={"gravity_m_s2": 9.8066})]
    accept = misstated(accept=["signs/gyro", "gravity"])
    assert (repairs(recorded(*wrong, accept, until="segment"))["state"] == "confirmed").all()


def test_a_repair_that_is_none_of_the_campaign_is_refused():
    with pytest.raises(Refusal) as said:
        accept = misstated(accept=["signs/gyros"])
        recorded(faults(flip("gyro", "y")), accept, until="segment")
    words = str(said.value)
    assert "campaign.yaml, line" in words and "accept[0]" in words
    assert "'signs/gyros'" in words and "signs/gyro" in words
    assert "remove it from accept" in words


@pytest.mark.slow
def test_two_positions_that_changed_places_are_exchanged_with_all_their_manoeuvres():
    """Of one log. It was the axes of a triad that no mounting has, with other causes beside it."""
    document = hidden_plans.stops(seed=5)
    document["handling"] = {"still_s": 4, "change_s": 8}
    for one in document["campaign"]["plan"]:
        one["log"] = "session.asc"
    true = laboratory.perform(laboratory.specify(document))
    plan = true.campaign["plan"]
    told = [*plan[:4], *plan[8:12], *plan[4:8], *plan[12:]]
    recording = replace(true, campaign={**true.campaign, "plan": told})
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    (repair,) = results["segment/repairs"].to_dict("records")
    assert repair["id"] == "exchanged_manoeuvres/x-down-before/y-up-before"
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "manoeuvre_swapped"
    assert set(results["diagnosis/verdict"]["verdict"]) == {"on_condition"}
    result = results["diagnosis/result"].set_index(["sensor", "parameter"])
    for sensor, name in (("accel", "accelerometer"), ("gyro", "gyro")):
        for i, axis in enumerate("xyz"):
            row = result.loc[sensor, f"scale_{axis}"]
            true_scale = document["truth"][name]["matrix"][i][i] - 1
            assert abs(row["value"] - true_scale) < 4 * row["sigma"]


@pytest.mark.slow
@pytest.mark.parametrize("faces", [True, False])
def test_logs_of_two_faces_are_exchanged_together_and_those_of_turns_by_their_sizes(faces):
    """All logs of two positions, or those of the turns alone: of one axis and sense, two sizes."""
    document = chain.short(seed=7)
    for one in document["campaign"]["plan"]:
        if one["id"].endswith("backward"):
            one["degrees"] = 1080
        if faces and one["up"].startswith("+"):
            one["position"] = one["up"]
    true = laboratory.perform(laboratory.specify(document))
    other = {"x": "y", "y": "x", "z": "z"}
    told = [
        one | {"log": other[one["id"][0]] + one["log"][1:]}
        if one["up"].startswith("+") and (faces or one["do"] == "turn")
        else one
        for one in true.campaign["plan"]
    ]
    recording = replace(true, campaign={**true.campaign, "plan": told})
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    pairs = {f"exchanged_manoeuvres/x-{one}/y-{one}" for one in ("forward", "backward")}
    repairs = results["segment/repairs"]
    assert {*repairs["id"]} == ({"exchanged_manoeuvres/x-backward/y-backward"} if faces else pairs)
    assert {*repairs["state"]} == {"applied"}
    assert list(results["diagnosis/causes"]["cause"]) == ["manoeuvre_swapped"] * len(repairs)
    assert {*results["diagnosis/verdict"]["verdict"]} == {"on_condition"}


def exchanging(found: int, fitting: set[tuple[str, int]]) -> Any:
    """An exchange with as many agreements as any, by which so many manoeuvres are found."""
    return SimpleNamespace(
        step=object(),
        balance=18,
        fitting=frozenset(fitting),
        of_exchange=True,
        of_sense=False,
        of_planned_size=6,
        found_whole=found,
        exchanged=(),
        plans=(),
        axes=None,
    )


@pytest.mark.parametrize(("found", "rival"), [(11, False), (12, True)])
def test_an_exchange_by_which_a_rest_is_not_found_is_no_rival_of_one_that_finds_all(found, rival):
    """Where a rest is not found, it is that before a turn, which then agrees with the plan."""
    case = SimpleNamespace(fitting=frozenset())
    best = exchanging(12, {("y-down", 0), ("z-up", 0)})
    other = exchanging(found, {("y-down", 0), ("y-forward", 1)})
    assert _rivals(case, best, other) == rival
