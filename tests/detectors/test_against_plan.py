"""Campaigns of the simulated laboratory that are not what their plan says."""

import json
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import degrees
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

import laboratory
from inertial.detectors.manoeuvres_against_plan import ManoeuvreMissing, TurningPointOnce
from inertial.signal.axis_permutations import PERMUTATIONS, Permutation, read_as_other_axes
from inertial.signal.misread_axes import determinant

Fault = dict[str, dict[str, Any]]
Edit = Callable[[str], str]


def segmented(
    faults: Sequence[Fault] = (), edit: Edit | None = None, **changes: Any
) -> chain.Results:
    """The short campaign with faults, its file edited, up to segment."""
    return run(chain.short(faults=list(faults), **changes), edit)


def run(document: dict[str, Any], edit: Edit | None = None) -> chain.Results:
    recording = laboratory.perform(laboratory.specify(document))
    return chain.in_memory(recording, "segment", edit=edit)


def found_in(results: chain.Results) -> pd.DataFrame:
    found = results["segment/findings"]
    words = found[["sentence", "consequence", "action"]].to_numpy().ravel()
    assert all(text and not re.search(r"\bnan\b| -", text) for text in words)
    return found


def performed(results: chain.Results) -> pd.DataFrame:
    return results["segment/performed"].set_index("manoeuvre")


def swap(log: str, sensor: str, axes: str) -> Fault:
    return {"swap": {"log": log, "sensor": sensor, "axes": list(axes)}}


def flip(log: str, sensor: str, axis: str) -> Fault:
    return {"flip": {"log": log, "sensor": sensor, "axis": axis}}


def exchange(*logs: str) -> Fault:
    return {"exchange": {"logs": list(logs)}}


BOTH = ("accelerometer", "gyro")


# ---- axes taken for others


@pytest.mark.slow
@pytest.mark.parametrize(
    ("faults", "cause", "sensors", "said"),
    [
        ([swap("all", "accelerometer", "xy")], "axis_swap", ["accel"], "x reads y and y reads x"),
        ([swap("all", "gyro", "yz")], "axis_swap", ["gyro"], "y reads z and z reads y"),
        ([flip("all", s, "y") for s in BOTH], "sign_flip", ["accel", "gyro"], "y reads −y"),
        ([flip("all", "accelerometer", "x")], "sign_flip", ["accel"], "x reads −x"),
        # Told from exchanged names by the rests, in which the gyros see the earth turn.
        ([flip("all", "gyro", "z")], "sign_flip", ["gyro"], "z reads −z"),
        ([swap("all", s, "xz") for s in BOTH], "axis_swap", ["accel", "gyro"], "x reads z"),
    ],
)
def test_axes_that_are_others_in_all_logs_are_named(faults, cause, sensors, said):
    results = segmented(faults)
    found = found_in(results)
    assert list(found["cause"]) == [cause] * len(sensors)
    assert list(found["sensor"]) == sensors
    assert list(found["id"]) == [f"segment/{cause}/{sensor}" for sensor in sensors]
    assert (found["severity"] == 3).all()
    for sentence in found["sentence"]:
        assert said in sentence and "in all logs" in sentence
        assert "determinant −1" in sentence
    # The readings are set right, so every manoeuvre is there.
    done = performed(results)
    assert done["complete"].all()
    assert len(results["segment/segments"]) == 6 + 6 * 5
    turns = done[done.index.str.contains("ward")]
    np.testing.assert_allclose(np.degrees(turns["angle"].abs()), 360, atol=1)
    if said == "y reads −y":  # the usual cause, by its name
        assert found["sentence"].str.contains("RAWIMUS has").all()
        assert found["consequence"].str.contains("scale error of y −200 %").all()


@pytest.mark.slow
def test_two_flips_that_cancel_are_told_by_the_determinant():
    faults = [flip("all", "accelerometer", axis) for axis in "xy"]
    (sentence,) = found_in(segmented(faults))["sentence"]
    assert "x reads −x and y reads −y" in sentence
    assert "determinant +1" in sentence and "two mistakes cancel" in sentence


@pytest.mark.slow
def test_an_imu_that_is_mounted_turned_says_so_in_both_sensors():
    faults = [f for s in BOTH for f in (flip("all", s, "x"), flip("all", s, "y"))]
    found = found_in(segmented(faults))
    assert list(found["cause"]) == ["sign_flip"] * 2
    assert found["sentence"].str.contains("may be mounted turned against the plan").all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("fault", "cause", "sensor"),
    [
        (swap("x-up.asc", "accelerometer", "xy"), "axis_swap", "accel"),
        (flip("y-down.asc", "accelerometer", "y"), "sign_flip", "accel"),
        (flip("y-forward.asc", "accelerometer", "y"), "sign_flip", "accel"),
        (swap("z-backward.asc", "gyro", "xz"), "axis_swap", "gyro"),
    ],
)
def test_axes_that_are_others_in_one_log_are_named_and_the_log_is_used(fault, cause, sensor):
    results = segmented([fault])
    (finding,) = found_in(results).to_dict("records")
    ((_, where),) = fault.items()
    name = where["log"].removesuffix(".asc")
    assert (finding["cause"], finding["sensor"], finding["severity"]) == (cause, sensor, 3)
    assert (finding["log"], finding["manoeuvre"]) == (where["log"], name)
    assert finding["to_s"] > finding["from_s"]
    assert performed(results)["complete"].all()
    assert finding["id"] in set(results["segment/close_ups"]["finding"])


@pytest.mark.slow
def test_one_long_log_is_found_by_the_right_axes():
    document = chain.short(faults=[swap("all", "accelerometer", "yz")])
    for manoeuvre in document["campaign"]["plan"]:
        del manoeuvre["log"]
    document["campaign"]["log"] = "session.asc"
    document["handling"]["change_s"] = 10
    results = run(document)
    assert list(found_in(results)["cause"]) == ["axis_swap"]
    assert performed(results)["complete"].all()


@pytest.mark.parametrize("askew", [pytest.param(5, marks=pytest.mark.slow), 20])
def test_an_imu_that_is_mounted_askew_raises_nothing(askew):
    document = chain.short()
    axis = np.array([1.0, -2.0, 2.0]) / 3
    x, y, z = np.sin(np.radians(askew)) * axis
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned = (
        np.eye(3)
        + across
        + (1 - np.cos(np.radians(askew))) / (x * x + y * y + z * z) * (across @ across)
    )
    for sensor in ("accelerometer", "gyro"):
        matrix = np.array(document["truth"][sensor]["matrix"]) @ turned
        document["truth"][sensor]["matrix"] = matrix.tolist()
    results = run(document)
    assert found_in(results).empty
    assert performed(results)["complete"].all()


# ---- names


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("x-up", "x-down"),
        pytest.param("x-up", "y-up", marks=pytest.mark.slow),
        ("z-forward", "z-backward"),
        pytest.param("x-forward", "y-forward", marks=pytest.mark.slow),
        pytest.param("z-down", "y-backward", marks=pytest.mark.slow),
    ],
)
def test_logs_under_each_others_names_are_named_and_taken_for_what_they_hold(one, other):
    results = segmented([exchange(f"{one}.asc", f"{other}.asc")])
    (finding,) = found_in(results).to_dict("records")
    assert finding["cause"] == "manoeuvre_swapped"
    assert finding["id"] == f"segment/manoeuvre_swapped/{one}"
    assert f"{one}.asc contains {other}" in finding["sentence"]
    assert f"{other}.asc contains {one}" in finding["sentence"]
    assert performed(results)["complete"].all()
    log = results["segment/manoeuvres"].set_index("manoeuvre")["log"]
    assert (log[one], log[other]) == (f"{other}.asc", f"{one}.asc")
    assert (log.drop([one, other]) == log.drop([one, other]).index + ".asc").all()


@pytest.mark.slow
def test_two_pairs_of_exchanged_logs_are_two_findings():
    faults = [exchange("x-up.asc", "x-down.asc"), exchange("y-forward.asc", "y-backward.asc")]
    found = found_in(segmented(faults))
    assert list(found["cause"]) == ["manoeuvre_swapped"] * 2


@pytest.mark.slow
def test_a_sign_that_would_look_the_same_is_told():
    """Without the rests beside turns about x, no other manoeuvre shows the sign of x."""
    document = chain.short(faults=[exchange("x-up.asc", "x-down.asc")])
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [
        one for one in plan if one["id"] not in ("x-forward", "x-backward")
    ]
    results = run(document)
    (finding,) = found_in(results).to_dict("records")
    assert "of the accelerometers, in all logs, x reads −x explains as much" in finding["sentence"]
    assert "accept: [signs/accel]" in finding["action"]
    done = performed(results)
    assert list(done.index[~done["found"]]) == ["x-up", "x-down"]


@pytest.mark.slow
def test_two_manoeuvres_in_each_others_place_within_a_log_are_named():
    document = chain.short()
    for manoeuvre in document["campaign"]["plan"]:
        del manoeuvre["log"]
    document["campaign"]["log"] = "session.asc"
    document["handling"]["change_s"] = 10

    def exchanged(text: str) -> str:
        lines = text.splitlines(keepends=True)
        i, j = (
            next(k for k, line in enumerate(lines) if f"id: {n}," in line) for n in ("x-up", "y-up")
        )
        lines[i], lines[j] = lines[j], lines[i]
        return "".join(lines)

    results = run(document, exchanged)
    (finding,) = found_in(results).to_dict("records")
    assert finding["cause"] == "manoeuvre_swapped"
    assert "y-up and x-up are exchanged" in finding["sentence"]
    done = performed(results)
    assert done.drop(["x-up", "y-up"])["complete"].all()


# ---- turns


def test_the_counts_of_another_instrument_are_one_finding():  # as S0 names its IMU
    results = segmented(edit=lambda text: text.replace("span-cpt", "imar-fsas"))
    (finding,) = found_in(results).to_dict("records")
    assert finding["id"] == "segment/wrong_scale_factor"
    assert (finding["cause"], finding["sensor"], finding["count"]) == (
        "wrong_scale_factor",
        "gyro",
        6,
    )
    assert 1 / finding["size"] == pytest.approx(57.29578, rel=1e-3)
    assert "the counts are those of span-cpt" in finding["sentence"]
    assert performed(results)["found"].all()


def test_a_gap_is_no_second_finding_beside_a_wrong_count():
    fault = {"lose": {"log": "z-backward.asc", "line": 550, "samples": 200}}
    results = segmented([fault], lambda text: text.replace("span-cpt", "imar-fsas"))
    assert list(found_in(results)["cause"]) == ["wrong_scale_factor"]
    assert list(results["quality/findings"]["cause"]).count("gap") == 1


def with_line(name: str, old: str, new: str):
    def edit(text: str) -> str:
        lines = text.splitlines(keepends=True)
        (k,) = [k for k, line in enumerate(lines) if f"id: {name}," in line]
        assert old in lines[k]
        lines[k] = lines[k].replace(old, new)
        return "".join(lines)

    return edit


def test_a_turn_against_the_plan_is_named():
    results = segmented(edit=with_line("x-forward", "degrees: 360", "degrees: -360"))
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("wrong_direction", "x-forward")
    assert finding["size"] == pytest.approx(-1, abs=1e-3)
    assert re.search(r"by 360\.2\d° in place of −360°", finding["sentence"])


def test_a_rate_that_is_not_the_planned_one_is_named_for_its_turn():
    edit = with_line("y-forward", "rate_deg_s: 60", "rate_deg_s: 30")
    (finding,) = found_in(segmented(edit=edit)).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("wrong_rate", "y-forward")
    assert finding["size"] == pytest.approx(2, abs=2e-3)
    assert finding["severity"] == 1  # the angle is right, and the angle is what counts
    assert "so its scale factor holds" in finding["consequence"]


def test_an_incomplete_turn_says_what_a_wrong_angle_would_cost():
    """The log ends while the table turns."""
    fault = {"lose": {"log": "z-backward.asc", "line": 800, "samples": 500}}
    results = segmented([fault])
    (finding,) = found_in(results).to_dict("records")
    assert finding["cause"] == "incomplete_turn"
    turn = performed(results).loc["z-backward"]
    assert not turn["complete"] and not turn["bridged"] and not turn["lost"]
    assert "ends while it turns" in finding["sentence"]
    assert finding["size"] == pytest.approx(degrees(turn["missing_angle"]))
    share = 1e6 * (degrees(turn["angle"]) / -360 - 1)
    thin = finding["consequence"].replace("\u202f", "").replace("−", "-")
    assert f"wrong by {share:.0f} ppm ({share / 2:.0f} ppm in a pair" in thin


def counted_by_100_hz(rate: float, folder: Path, **table: float) -> chain.Results:
    """The short campaign in columns without stamps, with turns of two angles, sampled at `rate`."""
    document = chain.short()
    document["receiver"] |= {"message": "columns", "line_end": "lf", "rate_hz": rate}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["table"] |= table
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn" and one["up"] == "+y":
            one["degrees"] *= 2
    campaign = chain.simulate(document, folder / "campaign") / "campaign.yaml"
    text = campaign.read_text()
    assert "time: {column: time, unit: s}" in text
    campaign.write_text(text.replace("time: {column: time, unit: s}", "time: {rate_hz: 100}"))
    return chain.run(campaign.parent, folder / "derived", "segment")


@pytest.mark.slow
@pytest.mark.parametrize("rate", [125, 50])
def test_samples_that_are_counted_by_another_rate_are_one_finding(rate, tmp_path):
    """Rates are read as they are, and every angle is off by the same ratio."""
    results = counted_by_100_hz(rate, tmp_path)
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["sensor"], finding["count"]) == ("rate_off", "gyro", 6)
    assert finding["size"] == pytest.approx(rate / 100, rel=2e-3)
    assert f"as if {rate}" in finding["sentence"] and f"rate_hz: {rate}" in finding["action"]
    assert performed(results)["found"].all()


@pytest.mark.slow
def test_a_rate_that_is_off_by_more_than_the_table_is_asked_about(tmp_path):
    """1000 ppm where the table keeps its rate to 100: all scale factors were off, "no fault"."""
    results = counted_by_100_hz(100.1, tmp_path, rate_sigma_ppm=100)
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["sensor"], finding["severity"]) == ("rate_off", "gyro", 2)
    assert finding["size"] == pytest.approx(1.001, abs=1e-4)
    assert "or the table is that much slower" in finding["sentence"]
    assert performed(results)["complete"].all()


@pytest.mark.slow
def test_samples_that_are_counted_by_their_rate_raise_nothing(tmp_path):
    results = counted_by_100_hz(100, tmp_path, rate_sigma_ppm=100)
    assert found_in(results).empty and performed(results)["complete"].all()


@pytest.mark.slow
def test_lost_samples_that_no_stamp_shows_make_no_asymmetry(tmp_path):
    """An asymmetry of 5500 ppm in two axes; a scale factor was 1300 sigma off, "within limits"."""
    document = chain.short(seed=3)
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["table"] |= {"rate_sigma_ppm": 100}
    folder = chain.simulate(document, tmp_path / "campaign")
    campaign = folder / "campaign.yaml"
    text = campaign.read_text()
    campaign.write_text(text.replace("time: {column: time, unit: s}", "time: {rate_hz: 100}"))
    for name in ("x-backward", "y-backward"):
        lines = (folder / f"{name}.asc").read_text().splitlines(keepends=True)
        middle = len(lines) // 2
        (folder / f"{name}.asc").write_text("".join(lines[:middle] + lines[middle + 8 :]))
    results = chain.run(folder, tmp_path / "derived", "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].query("sensor == 'gyro'").to_dict("records")
    assert (cause["cause"], cause["count"]) == ("samples_lost", 2)
    assert "x-backward (−355." in cause["sentence"] and "y-backward" in cause["sentence"]
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "not_usable"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["y-down", "x-down"])
def test_a_log_that_is_a_copy_of_another_is_told(tmp_path, name):
    """It was a missing manoeuvre, and nothing where the plan has the same attitude in both."""
    folder = chain.simulate(chain.short(seed=3), tmp_path / "campaign")
    (folder / f"{name}.asc").write_bytes((folder / "x-up.asc").read_bytes())
    if name == "x-down":
        campaign = folder / "campaign.yaml"
        campaign.write_text(re.sub(r"(id: x-down.*?up: )-x", r"\1+x", campaign.read_text()))
    results = chain.run(folder, tmp_path / "derived", "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].query("cause == 'copied_log'").to_dict("records")
    assert cause["log"] == f"{name}.asc" and "x-up.asc" in cause["sentence"]
    assert "manoeuvre_missing" not in set(results["diagnosis/causes"]["cause"])
    assert set(results["diagnosis/verdict"]["verdict"]) <= {"usable_within_limits", "not_usable"}


def overshooting(recording: laboratory.Recording, angle: float, seconds: float):
    """The recording by gyros that a table turns back by an angle, rad, after each of its stops."""
    records = {}
    for log, one in recording.records.items():
        counts = one.counts.astype(float)
        turned = counts[:, 3:].sum(axis=0) * recording.receiver.gyro_count
        axis = int(np.argmax(np.abs(turned)))
        if abs(turned[axis]) > 1.0:
            moving = np.abs(counts[:, 3 + axis]) > np.abs(counts[:, 3 + axis]).max() / 100
            stop = int(np.flatnonzero(moving)[-1]) + 1
            left = np.exp(-np.arange(len(counts) - stop + 1) * 0.01 / seconds)
            back = np.sign(turned[axis]) * angle / recording.receiver.gyro_count * left
            counts[stop:, 3 + axis] += np.diff(np.rint(back))
        records[log] = replace(one, counts=counts.astype(one.counts.dtype))
    return replace(recording, records=records)


@pytest.mark.slow
def test_a_table_that_overshoots_is_no_random_walk_of_the_gyros():
    """A random walk was named; scale factors 9 sigma off were "usable within limits"."""
    recording = laboratory.perform(laboratory.specify(chain.short(seed=7)))
    results = chain.in_memory(overshooting(recording, np.deg2rad(200 / 3600), 4.0), "segment")
    (found,) = found_in(results).to_dict("records")
    assert (found["cause"], found["sensor"], found["count"]) == ("motion_after_turns", "gyro", 6)
    assert -200 < degrees(found["size"]) * 3600 < -80  # of which a part is after the short rest
    assert found_in(chain.in_memory(recording, "segment")).empty


@pytest.mark.slow
def test_turns_that_are_hardly_steady_do_not_tell_the_rate():
    """Ramps of 13 s of 31: they count for steady in part, so 3 % were asked about, "not usable"."""
    document = chain.short()
    document["campaign"]["table"] |= {"rate_sigma_ppm": 100}
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn":
            one |= {"rate_deg_s": 20, "accel_deg_s2": 1.5}
    results = run(document)
    assert found_in(results).empty and performed(results)["complete"].all()


@pytest.mark.parametrize(("line", "samples"), [(500, 60), (330, 100)], ids=["steady", "ramp"])
def test_what_a_gap_takes_from_a_turn_is_told_by_the_gap_alone(line, samples):
    fault = {"lose": {"log": "z-backward.asc", "line": line, "samples": samples}}
    results = segmented([fault])
    assert found_in(results).empty
    (gap,) = results["quality/findings"].to_dict("records")
    assert (gap["cause"], gap["count"], gap["size"]) == ("gap", 1, samples)
    turn = performed(results).loc["z-backward"]
    assert turn["lost"] and not turn["complete"]
    bridged = line == 500
    assert turn["bridged"] == bridged == ("turned by 36.0° during the gap" in gap["sentence"])
    assert bridged or "is left out" in gap["action"]


# ---- what is missing


@pytest.mark.slow
def test_what_the_log_has_instead_is_told():
    # The IMU stood with z down; the plan has it so in another log as well.
    results = segmented(edit=with_line("z-down", "up: -z", "up: +y"))
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("manoeuvre_missing", "z-down")
    assert "rests 90° from there, with −z up" in finding["sentence"]
    assert "seen in y-up" in finding["consequence"]


def test_what_a_log_of_several_has_in_the_place_of_a_rest_is_told():
    document = chain.short(handling={"still_s": 10, "change_s": 10})
    for one in document["campaign"]["plan"]:
        one["log"] = "session.asc"
    document["misstated"] = {"plan": {"z-down": {"up": "+z"}}}
    told = chain.in_memory_of(document, "segment")["segment/findings"]
    (missing,) = told.query("cause == 'manoeuvre_missing'").to_dict("records")
    assert "In its place the log rests 180° from there, with −z up." in missing["sentence"]


def test_a_position_that_was_not_done_is_told_once():
    document = chain.short(handling={"still_s": 10, "change_s": 10})
    plan = document["campaign"]["plan"]
    y_up = [one for one in plan if one["id"] in ("y-up", "y-forward", "y-backward")]
    document["campaign"]["plan"] = [one for one in plan if one not in y_up]

    def edit(text: str) -> str:
        lines = [f"- {json.dumps(one | {'position': 'y-up'})}\n" for one in y_up]
        (first,) = [line for line in text.splitlines(keepends=True) if "id: z-up," in line]
        return text.replace(first, "".join("  " + line for line in lines) + first)

    for one in plan:
        one["log"] = "session.asc"
    (finding,) = found_in(run(document, edit)).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("manoeuvre_missing", "y-up")
    assert finding["count"] == 3
    assert "y-up, y-forward, y-backward were not found" in finding["sentence"]
    assert "No other turn is about y" in finding["consequence"]


def test_two_planned_rests_that_are_one_in_the_log_lose_nothing():
    """As where a tumble goes back, and nothing need move before the first rest of the way back."""

    def edit(text: str) -> str:
        (line,) = [line for line in text.splitlines(keepends=True) if "id: z-up," in line]
        return text.replace(line, line + line.replace("id: z-up,", "id: z-up-back,"))

    (finding,) = found_in(segmented(edit=edit)).to_dict("records")
    assert (finding["cause"], finding["severity"]) == ("manoeuvre_missing", 1)
    assert "is one rest with it where nothing moved between" in finding["consequence"]


@pytest.mark.parametrize(("tumble", "severities"), [("about-x", []), (None, [1]), ("other", [1])])
def test_where_a_tumble_goes_back_one_rest_is_what_is_planned(tumble, severities):
    up = np.tile([0.0, 0.6, 0.8], (3, 1))
    recorded = SimpleNamespace(
        name=["07", "back-07", "turn"],
        position=["07", "back-07", "turn"],
        do=["rest", "rest", "turn"],
        log=["one.csv"] * 3,
        found=np.array([True, False, True]),
        tumble=["about-x", tumble, None],
        explained=(),
        up=up,
    )
    detector = ManoeuvreMissing()
    detector.of = lambda recorded, i, rest, **own: own["severity"]
    assert list(detector.detect(recorded)) == severities
    # It is no fault, but that one rest fewer is found than planned is explained.
    explained = [one.facts for one in TurningPointOnce().detect(recorded)]
    assert explained == ([] if severities else [["back-07"]])


@pytest.mark.slow
def test_a_dead_gyro_does_not_hinder_the_others():
    logs = [f"{axis}-{way}.asc" for axis in "xyz" for way in ("up", "down", "forward", "backward")]
    faults = [
        {"kill": {"log": log, "channel": "gyro_z", "line": 1, "samples": n, "reads": "frozen"}}
        for log in logs
        for n in [1300 if "ward" in log else 2000]
    ]
    results = segmented(faults)
    found = found_in(results)
    assert list(found["manoeuvre"]) == ["z-forward", "z-backward"]
    assert set(found["cause"]) == {"manoeuvre_missing"}
    assert found["sentence"].str.contains("z gyro, which would see it, has no reading").all()
    assert performed(results).drop(["z-forward", "z-backward"])["complete"].all()


def test_a_rest_that_was_cut_off_is_told():
    results = segmented(edit=with_line("x-up", "seconds: 20", "seconds: 180"))
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("short_rest", "x-up")
    assert "3.0 times what was planned" in finding["consequence"]


# ---- the table


def test_a_table_that_creeps_is_named_in_the_rests_that_it_spoils():
    creep = {"table_creep": {"about": "north", "rate_deg_h": 10, "from_s": 85, "to_s": 95}}
    results = segmented(effects=creep)
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("table_moving", "x-down")
    assert (finding["unit"], finding["size"]) == ("″", pytest.approx(100, rel=0.1))
    # To a quarter of the rest, in which its tilt is looked at.
    assert finding["from_s"] == pytest.approx(85, abs=5.1)
    assert finding["to_s"] == pytest.approx(95, abs=5.1)


@pytest.mark.slow
def test_jumps_beside_turns_are_told_with_their_phase():
    place = {"log": "x-forward.asc", "channel": "gyro_y", "line": 130}
    results = segmented([{"step": place | {"size_rad_s": 7e-4, "samples": 600}}])
    (finding,) = found_in(results).to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("bias_jump", "x-forward")
    assert finding["sentence"].startswith("x-forward (rest-before):")


# ---- arrays alone


def test_an_attitude_is_told_from_axes_by_the_biases_of_the_sensors():
    generator = np.random.default_rng(5)
    matrix = np.eye(3) + 5e-3 * generator.standard_normal((3, 3))
    bias = 5e-3 * generator.standard_normal(3)
    ups = np.array([[-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1], [1, 0, 0]], float)

    def read(up: np.ndarray) -> np.ndarray:
        return matrix @ (9.8 * up) + bias + 1e-4 * generator.standard_normal(3)

    forces = np.array([read(up) for up in ups])
    right = np.array([1.0, 0.0, 0.0])
    for permutation in PERMUTATIONS:
        force = permutation.inverse.of(read(right))
        said = read_as_other_axes(force, right, forces, ups)
        other = permutation.inverse.of(right)
        if np.array_equal(other, right):
            continue  # the axis that points up is read as it is
        assert said == permutation
        assert read_as_other_axes(read(other), right, forces, ups) is None
    # By hand, where positions are off by a degree, it cannot be told.
    tilted = ups + np.radians(1) * generator.standard_normal(ups.shape)
    forces = np.array([read(up / np.linalg.norm(up)) for up in tilted])
    swapped = Permutation((1, 0, 2), (1, 1, 1)).of(read(right))
    assert read_as_other_axes(swapped, right, forces, ups) is None
    assert read_as_other_axes(swapped, right, forces[:2], ups[:2]) is None


def test_the_determinant_of_a_signed_permutation():
    one = Permutation((0, 1, 2), (1, 1, 1))
    assert determinant(one) == 1
    assert determinant(replace(one, signs=(1, -1, 1))) == -1
    assert determinant(replace(one, sources=(1, 0, 2))) == -1
    assert determinant(replace(one, sources=(1, 2, 0))) == 1
    assert sum(determinant(permutation) for permutation in PERMUTATIONS) == -1
