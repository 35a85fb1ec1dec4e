"""Findings of different stages that speak of the same thing refer to each other."""

from __future__ import annotations

from typing import Any

from stages.reporting.related import related

SEGMENTS = [
    {"manoeuvre": "turn", "log": "a.asc", "from_s": 10.0, "to_s": 50.0},
    {"manoeuvre": "other", "log": "a.asc", "from_s": 60.0, "to_s": 90.0},
]


def finding(identifier: str, **more: Any) -> dict[str, Any]:
    nothing = dict.fromkeys(("sensor", "log", "manoeuvre", "from_s", "to_s"))
    return {"id": identifier, "cause": identifier.split("/")[1], **nothing, **more}


def names(*rows: dict[str, Any]) -> dict[str, list[str]]:
    return {key: [row["id"] for row in each] for key, each in related(rows, SEGMENTS).items()}


GAP = finding("quality/gap/0", log="a.asc", from_s=20.0, to_s=30.0)
TURN = finding("segment/incomplete_turn/turn", log="a.asc", manoeuvre="turn")


def test_a_gap_and_the_turn_that_it_is_in() -> None:
    other = finding("segment/incomplete_turn/other", log="a.asc", manoeuvre="other")
    elsewhere = finding("quality/gap/1", log="b.asc", from_s=20.0, to_s=30.0)
    assert names(GAP, TURN, other, elsewhere) == {GAP["id"]: [TURN["id"]], TURN["id"]: [GAP["id"]]}


def test_what_lasts_the_whole_log_is_not_about_one_manoeuvre() -> None:
    always = finding("quality/clock_jitter/0", log="a.asc", from_s=0.0, to_s=100.0)
    assert names(always, TURN) == {}


def test_the_same_cause_in_the_recording_and_in_the_model() -> None:
    heard = finding("quality/oscillation/0", sensor="gyro", log="a.asc", from_s=0.0, to_s=100.0)
    other = finding("quality/oscillation/1", sensor="accel", log="a.asc", from_s=0.0, to_s=9.0)
    named = finding("criticism/oscillation", sensor="gyro")
    assert names(heard, other, named) == {heard["id"]: [named["id"]], named["id"]: [heard["id"]]}


def test_findings_of_one_stage_stand_for_themselves() -> None:
    assert names(GAP, finding("quality/gap/1", log="a.asc", from_s=20.0, to_s=30.0)) == {}
