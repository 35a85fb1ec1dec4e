"""Marks of a plan that contradict its turns: named, and set right where data or plan decide."""

from typing import Any

import chain
import numpy as np
import pytest
from test_repairs import in_one_log, misstated, noisy, pulls

BACK = [f"{axis}-backward" for axis in "xyz"]
MARKS = dict(zip("xyz", "yzx", strict=True))


def half_turns(heading: float | None, *, rests: bool = True) -> dict[str, Any]:
    """The short campaign in one log: turns by 180° there and back, the mark opposite between.

    rests : whether each axis rests upwards just before its turns, at the same mark
    """
    document = chain.short()
    document["campaign"]["table"]["heading_deg"] = heading
    plan = {m["id"]: m for m in document["campaign"]["plan"]}
    order = [*(f"{axis}-down" for axis in "xyz")]
    for axis, mark in MARKS.items():
        for way, sign, degrees in (("forward", "+", 180), ("backward", "-", -180)):
            plan[f"{axis}-{way}"] |= {"mark": sign + mark, "degrees": degrees}
        plan[f"{axis}-up"]["mark"] = "+" + mark
        rest, turns = [f"{axis}-up"], [f"{axis}-forward", f"{axis}-backward"]
        # With a rest on its other side a turn back is at the mark of the turn there as well.
        order += [*rest, *turns] if rests else turns
    order += [] if rests else [f"{axis}-up" for axis in "xyz"]
    document["campaign"]["plan"] = [plan[name] for name in order]
    in_one_log(document)
    return document


def copied(document: dict[str, Any]) -> dict[str, Any]:
    """The plan has the marks of the turns there for the turns back too."""
    misstated(plan={f"{axis}-backward": {"mark": "+" + mark} for axis, mark in MARKS.items()})(
        document
    )
    return document


def recorded(document: dict[str, Any], until: str = "gyroscope") -> chain.Results:
    return chain.in_memory_of(document, until)


@pytest.mark.slow
@pytest.mark.parametrize("heading", [40.0, None])
@pytest.mark.parametrize("rests", [True, False])
def test_marks_that_the_turns_contradict_are_those_that_the_turns_leave(heading, rests):
    results = recorded(copied(half_turns(heading, rests=rests)))
    (finding,) = results["segment/findings"].to_dict("records")
    (repair,) = results["segment/repairs"].to_dict("records")
    assert (finding["cause"], repair["id"]) == ("wrong_mark", "stated_marks")
    assert "Between x-forward and x-backward" in finding["sentence"]
    assert all(name in repair["condition"] for name in BACK)
    assert finding["size"] == pytest.approx(np.pi)
    if heading is None and not rests:
        assert repair["state"] == "rival" and "neither the plan nor" in finding["sentence"]
        return
    assert repair["state"] == "applied"
    assert ("earth's rate, as the gyros read it" in finding["sentence"]) == (heading is not None)
    marks = results["segment/manoeuvres"].set_index("manoeuvre")
    for axis, mark in MARKS.items():
        assert marks.loc[f"{axis}-backward", f"mark_{mark}"] == pytest.approx(-1)
    assert np.abs(pulls(results)[12:]).max() < 4.5


def test_the_earth_shows_the_marks_of_the_turns_there_to_be_the_wrong_ones():
    document = half_turns(40.0, rests=False)
    wrong = {f"{axis}-forward": {"mark": "-" + mark} for axis, mark in MARKS.items()}
    misstated(plan=wrong)(document)
    results = recorded(document, "segment")
    (repair,) = results["segment/repairs"].to_dict("records")
    assert repair["state"] == "applied"
    assert all(name in repair["condition"] for name in wrong)
    assert not any(name in repair["condition"] for name in BACK)


@pytest.mark.slow
def test_without_the_earth_in_sight_the_most_of_the_marks_are_right():
    document = copied(half_turns(40.0))
    noisy(document)
    results = recorded(document, "segment")
    (finding,) = results["segment/findings"].to_dict("records")
    assert "most of them agree on" in finding["sentence"]
    assert list(results["segment/repairs"]["state"]) == ["applied"]


def test_marks_that_go_with_the_turns_are_left_alone():
    results = recorded(half_turns(40.0))
    assert results["segment/findings"].empty and results["segment/repairs"].empty
    assert np.abs(pulls(results)[12:]).max() < 4.5


@pytest.mark.slow
def test_a_table_that_is_moved_between_two_turns_may_have_any_mark():
    document = half_turns(40.0)
    for m in document["campaign"]["plan"]:
        if m["id"] in BACK:  # the table goes on to the mark of the turn there
            m["mark"] = "+" + MARKS[m["id"][0]]
    results = recorded(document)
    assert results["segment/findings"].empty and results["segment/repairs"].empty
    assert np.abs(pulls(results)[12:]).max() < 4.5
