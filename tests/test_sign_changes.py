"""A gyro whose sign changes in the course of a campaign is not set right where it was right."""

from typing import Any

import chain
import pytest
from test_repairs import all_turns, flip, in_one_log

BIAS = 1.1e-4  # rad/s, 23 °/h, of the y gyro: against 10.6 °/h of the earth's rate across
TURNS = ("y-forward", "y-backward", "y-down-forward", "y-down-backward")


def fourteen_logs() -> dict[str, Any]:
    """The short campaign with turns about −y too: no two logs exchanged explain four turns."""
    document = chain.short()
    document["truth"]["gyro"]["bias_rad_s"][1] = BIAS
    plan = document["campaign"]["plan"]
    for m in [m for m in plan if m["id"] in TURNS]:
        name = m["id"].replace("y-", "y-down-")
        plan.append({**m, "id": name, "up": "-y", "log": f"{name}.asc"})
    return document


def recorded(first: str, until: str) -> chain.Results:
    """The short campaign, the y gyro reversed from one manoeuvre on, each in a log of its own."""
    document = fourteen_logs()
    names = [m["id"] for m in document["campaign"]["plan"]]
    document["faults"] = [flip("gyro", "y", f"{name}.asc") for name in names[names.index(first) :]]
    return chain.in_memory_of(document, until)


@pytest.mark.slow
@pytest.mark.parametrize("first", ["y-down", "x-forward"])
def test_only_the_logs_are_set_right_in_which_a_gyro_is_reversed(first):
    results = recorded(first, "gyroscope")
    names = list(results["segment/manoeuvres"]["manoeuvre"])
    reversed_in = {f"{name}.asc" for name in names[names.index(first) :]}
    channels = results["segment/channel_repairs"]
    assert set(channels["log"]) == reversed_in
    (repair,) = results["segment/repairs"].to_dict("records")
    assert (repair["id"], repair["state"]) == ("signs/gyro", "applied")
    assert f"from {first} on" in repair["sentence"]
    (finding,) = results["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["axis"]) == ("sign_flip", "y")
    before = names[names.index(first) - 1]
    assert f"between {before} and {first}" in finding["sentence"]
    assert ", ".join(TURNS) in finding["sentence"]
    value = results.parameters("gyroscope").loc["bias_y"]
    assert abs(value["value"] - BIAS) < 4 * value["sigma"]


@pytest.mark.slow
def test_a_gyro_that_is_reversed_all_along_is_so_in_all_logs_whatever_its_bias():
    results = recorded("x-up", "gyroscope")
    (finding,) = results["segment/findings"].to_dict("records")
    assert "in all logs" in finding["sentence"]
    assert len(set(results["segment/channel_repairs"]["log"])) == 14
    value = results.parameters("gyroscope").loc["bias_y"]
    assert abs(value["value"] - BIAS) < 4 * value["sigma"]


@pytest.mark.slow
def test_nothing_is_set_right_where_a_gyro_changes_its_sign_within_a_log():
    document = fourteen_logs()
    in_one_log(document)
    # So much noise that no two records show the change by themselves.
    document["noise"]["angle_random_walk_deg_sqrt_h"] = 0.15
    segments = chain.in_memory_of(document, "segment")["segment/segments"].set_index("manoeuvre")
    # At rest, for in motion a single record shows it, and before what is used of the rest.
    line = int(segments.loc["z-up", "from_record"]) - 20
    document["faults"] = [{"flip": {**flip("gyro", "y", "session.asc")["flip"], "line": line}}]
    results = chain.in_memory_of(document, "segment")
    assert len(results["segment/channel_repairs"]) == 0 == len(results["segment/repairs"])
    found = results["segment/findings"]
    (finding,) = found[found["cause"] == "sign_flip"].to_dict("records")
    assert "changes between y-down and z-up" in finding["sentence"]
    assert "Nothing is set right" in finding["action"]


def in_one_session(first: str = "", after: str = "") -> tuple[chain.Results, list[int]]:
    """All in one log, the y gyro reversed from before one rest until before another.

    So much noise that no two records show a change by themselves. Records of the changes as well.
    """
    document = chain.short()
    in_one_log(document)
    document["noise"]["angle_random_walk_deg_sqrt_h"] = 0.15
    lines = []
    if first:
        segments = chain.in_memory_of(document, "segment")["segment/segments"]
        begins = segments.drop_duplicates("manoeuvre").set_index("manoeuvre")["from_record"]
        lines = [int(begins[name]) - 20 for name in (first, after)]
        fault = {**flip("gyro", "y")["flip"], "line": lines[0], "samples": lines[1] - lines[0]}
        document["faults"] = [{"flip": {**fault, "log": "session.asc"}}]
    return chain.in_memory_of(document, "gyroscope"), lines


@pytest.mark.parametrize(("first", "after"), [("y-up", "z-down"), ("x-down", "z-down")])
def test_a_gyro_that_is_reversed_between_two_rests_is_left_out_there(first, after):
    results, (line, end) = in_one_session(first, after)
    assert results["segment/channel_repairs"].empty and results["segment/repairs"].empty
    findings = results["segment/findings"]
    (finding,) = findings[findings["cause"] == "sign_flip"].to_dict("records")
    assert (finding["sensor"], finding["axis"]) == ("gyro", "y")
    assert "reads its negative in a part of the recording" in finding["sentence"]
    segments = results["segment/segments"].sort_values("from_record")
    order = segments.drop_duplicates("manoeuvre")["manoeuvre"].tolist()
    inside = order[order.index(first) : order.index(after)]
    # One on either side may be in it too, where no motion tells.
    assert len(inside) <= finding["size"] <= len(inside) + 2 and finding["unit"] == "manoeuvres"
    own = segments[segments["manoeuvre"].isin(inside)]
    assert finding["from_s"] < own["from_s"].min() + 1 and own["to_s"].max() - 1 < finding["to_s"]
    assert "only if y is negated" in finding["sentence"]
    wrong = "Used unchanged, the y scale factor would have the wrong sign there."
    assert finding["consequence"] == wrong
    assert finding["action"].startswith("The y gyro is left out there")
    masks = results["segment/masks"]
    (mask,) = masks[masks["finding"] == finding["id"]].to_dict("records")
    assert (mask["sensor"], mask["axis"]) == ("gyro", "y")
    assert mask["from_record"] <= line and end <= mask["to_record"]
    assert mask["to_record"] - mask["from_record"] < end - line + 6000  # a rest on either side
    assert results["segment/performed"]["complete"].all()
    assert results.parameters("gyroscope")["value"].notna().all()


@pytest.mark.slow
def test_of_a_gyro_that_reads_as_it_should_no_part_is_left_out():
    results, _lines = in_one_session()
    assert results["segment/masks"].empty and results["segment/findings"].empty


def test_of_signs_that_fit_the_plan_less_than_the_readings_none_is_set_right():
    """Every gyro reversed and every turn counted the other way: the turns are as planned."""
    document = chain.short()
    in_one_log(document)
    document["faults"] = [flip("gyro", axis) for axis in "xyz"]
    all_turns(lambda m: {**m, "degrees": -m["degrees"]})(document)
    results = chain.in_memory_of(document, "segment")
    (repair,) = results["segment/repairs"].to_dict("records")
    assert (repair["id"], repair["state"]) == ("signs/gyro/by-gravity", "rival")
    assert repair["fitting_after"] < repair["fitting_before"]
    assert results["segment/channel_repairs"].empty
    assert results["segment/performed"]["complete"].all()
