"""Findings of different stages that speak of the same thing refer to each other."""

from __future__ import annotations

from typing import Any

from stages.report.sections.findings import related

SEGMENTS = [
    {"manoeuvre": "turn", "log": "a.asc", "from_s": 10.0, "to_s": 50.0},
    {"manoeuvre": "other", "log": "a.asc", "from_s": 60.0, "to_s": 90.0},
]


def finding(identifier: str, **more: Any) -> dict[str, Any]:
    nothing = dict.fromkeys(("sensor", "log", "manoeuvre", "from_s", "to_s"))
    stage, cause, *_ = identifier.split("/")
    return {"id": identifier, "stage": stage, "cause": cause, **nothing, **more}


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


def test_a_drift_with_the_temperature_and_what_it_does_to_the_model() -> None:
    drift = finding("quality/temperature_drift/0", sensor="gyro", log="a.asc", from_s=0.0, to_s=9.0)
    bias = finding("criticism/gyro_bias_temperature", sensor="gyro")
    sweep = finding("criticism/temperature/warm/gyro", sensor="gyro") | {
        "cause": "unknown_structure",
        "predictor": "temperature",
    }
    other = finding("criticism/accel_bias_temperature", sensor="accel")
    found = names(drift, bias, sweep, other)
    assert found[drift["id"]] == [bias["id"], sweep["id"]]
    assert other["id"] not in found


def test_an_oscillation_that_the_model_has_as_a_ripple_of_the_table() -> None:
    heard = finding("quality/oscillation/0", sensor="gyro", log="a.asc", from_s=0.0, to_s=100.0)
    ripple = finding("criticism/table_ripple", sensor="gyro")
    ramp = finding("criticism/gyro_bias_ramp", sensor="gyro")
    assert names(heard, ripple, ramp) == {heard["id"]: [ripple["id"]], ripple["id"]: [heard["id"]]}


def test_a_position_that_is_off_and_the_effect_that_it_was_taken_for() -> None:
    off = finding("accelerometer/table_position_error/z-down", sensor="accel")
    named = finding("criticism/accel_quadratic", sensor="accel", verdict="one_of_class")
    unsure = finding("criticism/accel_bias_ramp", sensor="accel", verdict="unknown_structure")
    assert names(off, named, unsure) == {off["id"]: [named["id"]], named["id"]: [off["id"]]}
