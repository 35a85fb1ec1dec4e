"""Which finding is the cause of which: a few findings at a time, as the stages write them."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from inertial.campaign.competition import ExplainedFindings, compete
from inertial.campaign.hypotheses import Hypothesis
from inertial.campaign.where_causes_act import shows_wrong_stamps
from stages.diagnosis.causes import Cause, Evidence, _may_be_shift

APPLIED = {"state": "applied", "axis": None}
RIVAL = {"state": "rival", "axis": None}


def finding(
    stage: str, cause: str, sensor: str | None = None, severity: int = 2, **more: Any
) -> Hypothesis:
    """A finding without a place; `more`: of the hypothesis."""
    row = dict.fromkeys(("axis", "mount", "log", "manoeuvre", "size", "p_value"))
    row |= {"sensor": sensor, "severity": severity, "count": 1}
    return Hypothesis(f"{stage}/{cause}/{sensor}", stage, cause, row, **more)


def causes(*findings: Hypothesis) -> dict[str, set[str]]:
    """By cause the findings that it explains, its own left out."""
    return {
        each.cause.cause: {other.cause for other in each.consequences} - {each.cause.cause}
        for each in compete(findings)
    }


def effect(cause: str, sensor: str, verdict: str = "found", *members: str) -> Hypothesis:
    return finding("criticism", cause, sensor, verdict=verdict, members=members)


def of(*manoeuvres: str) -> dict[str, Any]:
    return {"manoeuvres": frozenset(manoeuvres)}


def test_a_gap_explains_the_turn_that_it_cuts_and_no_other():
    gap = finding("quality", "gap", severity=1, **of("z-back"))
    cut = finding("segment", "incomplete_turn", "gyro", **of("z-back"))
    other = finding("segment", "incomplete_turn", "accel", **of("x-back"))
    assert causes(gap, cut) == {"gap": {"incomplete_turn"}}
    assert causes(gap, other) == {"gap": set(), "incomplete_turn": set()}


def test_a_dead_axis_explains_a_force_at_rest_that_is_no_gravity():
    dead = finding("quality", "dead_axis", "accel")
    factor = finding("quality", "wrong_scale_factor", "accel", severity=3)
    assert causes(dead, factor) == {"dead_axis": {"wrong_scale_factor"}}


def test_a_position_that_was_moved_explains_the_step_in_it_and_no_other():
    moved = finding("accelerometer", "moved_while_read", "accel", severity=1, **of("by-hand-06"))
    step = finding("quality", "bias_jump", "accel", **of("by-hand-06"))
    other = finding("quality", "bias_jump", "accel", **of("by-hand-09"))
    assert causes(moved, step) == {"moved_while_read": {"bias_jump"}}
    assert causes(moved, other) == {"moved_while_read": set(), "bias_jump": set()}


@pytest.mark.parametrize(("stage", "sensor"), [("accelerometer", "accel"), ("gyroscope", "gyro")])
def test_a_position_that_was_moved_is_left_out(stage, sensor):
    moved = finding(stage, "moved_while_read", sensor, severity=1, **of("by-hand-06"))
    moved = replace(moved, row=moved.row | {"manoeuvre": "by-hand-06"})
    (cause,) = Evidence({}, frozenset(), {}).causes([ExplainedFindings(moved, (moved,))])
    assert cause.cure == "left_out" and "left out" in cause.done


def test_lines_of_one_turn_are_one_cause_and_those_of_others_their_own():
    def line(name: str, turn: str | None) -> ExplainedFindings:
        found = effect("oscillation", "gyro")
        found = replace(found, id=name, row=found.row | {"manoeuvre": turn})
        return ExplainedFindings(found, (found,))

    lines = [line("1", "z-back"), line("2", "z-back"), line("3", "x"), line("4", None)]
    made = Evidence({}, frozenset(), {}).causes([*lines, line("5", None)])
    assert [[m.cause.id for m in one.members] for one in made] == [["1", "2"], ["3"], ["4"], ["5"]]


def test_what_disturbs_a_position_explains_that_its_attitude_seems_off():
    """Exchanged axes that are both level: a tilt by degrees, which is an unknown of the result."""
    off = finding("accelerometer", "table_position_error", "accel", 1, **of("y-up"))
    for place, explained in (("y-up", True), ("x-up", False)):
        bias = replace(effect("accel_bias_of_position", "accel"), **of(place))
        assert ("table_position_error" in causes(bias, off)["accel_bias_of_position"]) == explained
    assert not causes(effect("accel_quadratic", "accel"), off)["accel_quadratic"]


@pytest.mark.parametrize(("turns", "explained"), [(("z-back",), True), (("z-back", "z"), False)])
def test_lines_of_the_turn_that_alone_carries_a_structure_are_its_spectrum(turns, explained):
    """A step of a gyro within a turn was up to six oscillations beside it."""
    step = finding("criticism", "unknown_structure", "gyro", verdict="unknown_structure")
    step = replace(step, manoeuvres=frozenset({"z-back"}))
    line = replace(effect("oscillation", "gyro"), manoeuvres=frozenset(turns))
    assert ("oscillation" in causes(step, line)["unknown_structure"]) == explained


@pytest.mark.parametrize(("repair", "both"), [("applied", True), ("rival", False)])
def test_what_another_repair_sets_right_is_a_cause_with_its_condition(repair, both):
    """Exchanged axes and rad/s stated as °/s: 57.3 was left out of the condition."""
    axes = {"id": "axes/gyro", "state": "applied", "axis": None}
    swap = finding("segment", "axis_swap", "gyro", 3, repair=axes)
    unit = {"id": "count_size/gyro", "state": repair, "axis": None}
    scale = finding("segment", "wrong_scale_factor", "gyro", 3, repair=unit)
    assert (
        set(causes(swap, scale)) == {"axis_swap", "wrong_scale_factor"} if both else {"axis_swap"}
    )


@pytest.mark.parametrize(("rest", "explained"), [("p-01", {"bias_jump"}), ("p-02", set())])
def test_a_clipped_motion_does_not_explain_the_jump_of_a_bias_at_rest(rest, explained):
    clipped = finding("quality", "saturation", "gyro", **of("p-01"), masked=True)
    jump = finding("segment", "bias_jump", "gyro", **of(rest))
    assert causes(clipped, jump)["saturation"] == explained
    assert len(causes(clipped, jump)) == 2 - len(explained)


@pytest.mark.parametrize(
    ("carrying", "moved", "explained"),
    [
        (("x-up",), ("x-up",), True),
        (("x-up",), ("z-down",), False),
        (("x-up", "z-down"), ("x-up",), False),
        ((), ("x-up",), False),  # no few manoeuvres carry it
        ((), ("x-up", "x-down", "y-up", "y-down"), True),
        (("x-up", "z-down"), ("x-up", "z-down"), True),
        (("x-up",), (), True),  # a fault of all the log
    ],
)
def test_a_fault_explains_only_the_structure_that_its_manoeuvres_carry(carrying, moved, explained):
    moving = finding("segment", "table_moving", **of())
    each = [replace(moving, id=f"{moving.id}/{one}", **of(one)) for one in moved] or [moving]
    structure = effect("unknown_structure", "gyro", "unknown_structure")
    structure = replace(structure, **of(*carrying))
    assert ("unknown_structure" not in causes(*each, structure)) == explained


@pytest.mark.parametrize(("seconds", "explained"), [(3.2, False), (30.0, True)])
def test_no_bias_of_a_gyro_walks_by_a_tilt_of_seconds(seconds, explained):
    """`imu_tk_xsens`: 1070″ in 3.2 s of one rest are no walk of 970 °/h/√h over 512 s."""
    tilts = finding("segment", "table_moving", **of("positions-14"))
    tilts.row.update(from_s=207.88, to_s=207.88 + seconds, size=1069.0)
    walk = effect("gyro_random_walk", "gyro", "unknown_structure")
    assert ("gyro_random_walk" not in causes(tilts, walk)) == explained


def test_a_jump_within_a_rest_may_be_a_shift_of_the_case():
    jump = finding("segment", "bias_jump", "accel", **of("y-up"))
    assert causes(jump, effect("mounting_shift", "accel")) == {"mounting_shift": {"bias_jump"}}


def test_an_effect_explains_the_position_that_it_looks_like():
    off = finding("accelerometer", "table_position_error", "accel")
    quadratic = effect("accel_quadratic", "accel", "one_of_class", "accel_scale_asymmetry")
    assert causes(off, quadratic) == {"accel_quadratic": {"table_position_error"}}
    assert set(causes(off, effect("gyro_g_sensitivity", "gyro"))) == {
        "table_position_error",
        "gyro_g_sensitivity",
    }


def test_the_model_speaks_for_what_the_recording_shows_of_the_same_physics():
    line = finding("quality", "oscillation", "gyro", 1)
    assert causes(line, effect("table_ripple", "gyro")) == {"table_ripple": {"oscillation"}}


def test_what_has_no_law_is_one_cause_of_a_sensor():
    walk = effect("gyro_random_walk", "gyro", "unknown_structure")
    structure = effect("unknown_structure", "gyro", "unknown_structure")
    demoted = effect("gyro_bias_ramp", "gyro", "unknown_structure")
    rest = finding("criticism", "unexplained", "gyro")
    assert causes(rest, demoted, walk, structure) == {
        "unknown_structure": {"gyro_random_walk", "gyro_bias_ramp", "unexplained"}
    }
    accel = finding("criticism", "unexplained", "accel")
    assert len(list(compete([demoted, accel]))) == 2


@pytest.mark.parametrize(
    ("p_value", "severity", "named"),
    [(None, 1, False), (0.02, 1, False), (1e-6, 1, True), (None, 2, True)],
)
def test_a_random_walk_that_chance_may_make_is_noise_and_no_cause(p_value, severity, named):
    """Nor is one that only the noise at rest shows, which has no p-value, if a sensor may have it.

    Of severity 2 it is faster than that.
    """
    walk = effect("gyro_random_walk", "gyro", "unknown_structure", "gyro_random_walk")
    walk.row.update({"p_value": p_value, "severity": severity})
    assert bool(causes(walk)) == named
    rest = finding("criticism", "unexplained", "gyro")
    assert causes(walk, rest) == {"gyro_random_walk": {"unexplained"}}


@pytest.mark.parametrize(
    ("cause", "sensor", "explained"),
    [
        ("motion_after_turns", "gyro", ("gyro_random_walk", "gyro")),
        ("position_not_kept", None, ("accel_random_walk", "accel")),
        ("position_not_kept", None, ("position_scatter", None)),
        ("fixture_creep", None, ("accel_random_walk", "accel")),
        ("fixture_creep", None, ("mounting_shift", "accel")),
        ("normalised_force", "accel", ("accel_scale_asymmetry", "accel")),
    ],
)
def test_what_a_session_did_explains_what_the_model_sees_of_it(cause, sensor, explained):
    fault = finding("segment", cause, sensor, 3)
    verdict = "unknown_structure" if "walk" in explained[0] else "found"
    other = effect(*explained, verdict, *explained[:1])
    other.row["p_value"] = 1e-9
    assert causes(fault, other) == {cause: {explained[0]}}


def test_a_named_effect_explains_no_remaining_misfit():
    rest = finding("criticism", "unexplained", "gyro")
    assert causes(effect("gyro_g_sensitivity", "gyro"), rest) == {
        "gyro_g_sensitivity": set(),
        "unexplained": set(),
    }


@pytest.mark.parametrize(
    ("more", "named"),
    [({}, False), ({"repair": APPLIED}, True), ({"repair": RIVAL, "rivals": (RIVAL,)}, False)],
)
def test_from_what_a_fault_spoils_no_effect_is_named_until_it_is_set_right(more, named):
    fault = finding("segment", "sign_flip", "gyro", 3, **more)
    found = causes(fault, effect("gyro_g_sensitivity", "gyro"))
    assert ("gyro_g_sensitivity" in found) == named
    assert "gyro_g_sensitivity" in causes(
        finding("segment", "sign_flip", "accel", 3), effect("gyro_g_sensitivity", "gyro")
    )


@pytest.mark.parametrize(
    ("found", "explained"),
    [
        (effect("accel_y_telegraph_of_time", "accel", "law"), True),  # two levels: of that log
        (effect("accel_scale_asymmetry", "accel"), True),
        (effect("accel_bias_ramp", "accel"), False),
        (effect("gyro_y_cubic_of_time", "gyro", "law"), False),
    ],
)
def test_a_clock_that_is_wrong_explains_what_is_in_proportion_and_laws(found, explained):
    clock = finding("quality", "clock_scale", "accel")
    assert (found.cause not in causes(clock, found)) == explained


@pytest.mark.parametrize("alike", [True, False])
def test_a_clock_that_is_off_by_as_much_in_all_logs_is_in_the_scale_factors_alone(alike):
    clock = finding("quality", "clock_scale", "gyro", alike=alike)
    named = effect("gyro_scale_asymmetry", "gyro")
    unnamed = effect("unknown_structure", "gyro", "unknown_structure")
    assert ("gyro_scale_asymmetry" in causes(clock, named)) == alike
    assert ("unknown_structure" in causes(clock, unnamed)) == alike


@pytest.mark.parametrize(("ratio", "explained"), [(1.0004, True), (1.01, False)])
def test_a_clock_explains_what_is_off_by_no_more_than_it_is(ratio, explained):
    clock, turns = finding("quality", "clock_scale", "gyro"), finding("segment", "rate_off")
    clock = replace(clock, row=clock.row | {"size": 350.0})  # ppm
    turns = replace(turns, row=turns.row | {"size": ratio})
    assert ("rate_off" not in causes(clock, turns)) == explained


@pytest.mark.parametrize(
    ("ppm", "ratio", "wrong"),
    [(200.0, 1.0002, True), (-200.0, 0.9998, True), (200.0, 0.9998, False), (200.0, 1.0004, False)],
)
def test_turns_that_are_off_by_as_much_as_the_stamps_show_that_these_are_wrong(ppm, ratio, wrong):
    clock, turns = finding("quality", "clock_scale", "gyro"), finding("segment", "rate_off")
    clock = replace(clock, row=clock.row | {"size": ppm})
    turns = replace(turns, row=turns.row | {"size": ratio})
    assert shows_wrong_stamps(clock, turns) == wrong


@pytest.mark.parametrize(("amplitude", "explained"), [(3e-5, True), (3e-3, False)])
def test_coarse_counts_explain_an_oscillation_that_is_smaller_than_they_are(amplitude, explained):
    coarse, rings = finding("quality", "quantisation", "gyro"), effect("oscillation", "gyro")
    coarse = replace(coarse, row=coarse.row | {"size": 1e-4})
    rings = replace(rings, row=rings.row | {"size": amplitude})
    assert ("oscillation" not in causes(coarse, rings)) == explained


def test_a_temperature_that_changes_is_no_fault():
    assert causes(finding("quality", "temperature_drift")) == {}


def test_every_finding_is_told_once():
    many = [
        finding("quality", "saturation", "gyro", 3, **of("x", "y")),
        finding("segment", "incomplete_turn", "gyro", **of("x")),
        finding("segment", "wrong_rate", "gyro", **of("y")),
        finding("quality", "oscillation", "gyro", 1),
        effect("oscillation", "gyro"),
    ]
    told = [other.id for each in compete(many) for other in each.consequences]
    assert sorted(told) == sorted(one.id for one in many)


def test_residuals_of_the_gyros_that_a_shift_might_explain_are_no_fault_of_the_accelerometers():
    shift = ("mounting_shift", "gyro_bias_jump")
    assert _may_be_shift(effect("mounting_shift", "gyro", "one_of_class", *shift))
    assert _may_be_shift(effect("gyro_bias_jump", "gyro", "one_of_class", *shift))
    assert not _may_be_shift(effect("unknown_structure", "gyro", "unknown_structure", *shift))


def test_a_turn_that_was_not_recorded_has_no_rate_of_its_own():
    cut = finding("segment", "incomplete_turn", "gyro", **of("z-back"))
    rate = finding("segment", "wrong_rate", "gyro", **of("z-back"))
    other = finding("segment", "wrong_rate", "gyro", **of("x-back"))
    assert causes(cut, rate) == {"incomplete_turn": {"wrong_rate"}}
    assert set(causes(cut, other)) == {"incomplete_turn", "wrong_rate"}


def test_what_the_logs_and_the_turns_show_alike_is_told_once():
    """Stamps in another unit: by the stated rate of the samples, and by turns 1000 times as far."""
    stamps = finding("quality", "wrong_time_unit", None, 3)
    turns = finding("segment", "wrong_time_unit", "gyro", 3)
    assert len([*compete([stamps, turns])]) == len([*compete([turns, stamps])]) == 1


@pytest.mark.parametrize(("missing", "explained"), [(-5.0, True), (-356.7, False)])
def test_single_readings_explain_no_turn_of_which_most_is_missing(missing, explained):
    glitch = finding("quality", "periodic_glitch", "gyro", 1, **of("x+360"))
    turn = finding("segment", "incomplete_turn", "gyro", 2, **of("x+360"))
    turn = replace(turn, row=turn.row | {"size": missing})
    assert ("incomplete_turn" not in causes(glitch, turn)) == explained


def at(one: Hypothesis, seconds: float, sigma: float, arcsec: float | None = None) -> Hypothesis:
    """The same finding at a time, and with an angle by which the case turns."""
    angle = None if arcsec is None else arcsec * np.radians(1 / 3600)
    return replace(one, time=(seconds, sigma), angle=angle)


@pytest.mark.parametrize(
    ("seconds", "arcsec", "one"),
    [(192.8, 379, True), (320.0, 379, False), (192.8, 30, False)],
)
def test_a_rest_in_which_the_imu_tilts_is_the_shift_that_begins_there(seconds, arcsec, one):
    """360″ about z at 192.8 s: found as 338″ at 194 ± 13 s, and as a tilt of 379″ in the rest."""
    shift = at(effect("mounting_shift", "accel"), 194.4, 13.2, 338)
    tilt = at(finding("segment", "table_moving", **of("x-up")), seconds, 0.04, arcsec)
    jump = finding("segment", "bias_jump", "gyro", **of("x-up"))
    said = causes(shift, tilt, jump)
    assert said == (
        {"mounting_shift": {"table_moving", "bias_jump"}}
        if one
        else {"mounting_shift": set(), "table_moving": {"bias_jump"}}
    )


@pytest.mark.parametrize(
    ("sensor", "seconds", "sigma", "one"),
    [
        ("accel", 1357.9, 1.2, True),
        ("accel", 1372.0, 1.2, False),
        ("accel", 1300.0, 60.0, False),  # a time that is not known agrees with any
        ("gyro", 1357.9, 1.2, False),
    ],
)
def test_a_level_accelerometer_that_jumps_in_a_rest_is_the_tilt_of_the_table(
    sensor, seconds, sigma, one
):
    """17″ of the table at 1357.9 ± 1.2 s; there the z accelerometer jumps by 86 µg."""
    tilt = at(effect("table_tilt_jump", "accel"), seconds, sigma)
    jump = at(finding("segment", "bias_jump", sensor, **of("y-down")), 1358.01, 0.03)
    assert causes(tilt, jump) == (
        {"table_tilt_jump": {"bias_jump"}}
        if one
        else {"table_tilt_jump": set(), "bias_jump": set()}
    )


@pytest.mark.parametrize(
    ("seconds", "sigma", "verdict", "one"),
    [
        (125.0, 2.5, "found", True),
        (140.0, 2.5, "found", False),
        (125.0, 60.0, "found", False),  # a time that is not known agrees with any
        (125.0, 2.5, "one_of_class", False),
    ],
)
def test_biases_of_both_sensors_that_jump_at_once_are_one_knock(seconds, sigma, verdict, one):
    gyro = at(effect("gyro_bias_jump", "gyro"), 124.89, 0.16)
    accel = at(effect("accel_bias_jump", "accel", verdict), seconds, sigma)
    said = list(compete([accel, gyro]))
    assert [each.cause.cause for each in said] == (
        ["gyro_bias_jump"] if one else ["accel_bias_jump", "gyro_bias_jump"]
    )
    if one:  # it is a cause of both sensors, with the effects of both
        assert said[0].cause.sensor is None
        assert said[0].cause.causes == {"gyro_bias_jump", "accel_bias_jump"}


@pytest.mark.parametrize(
    ("name", "place", "one"),
    [
        ("turn_angle_error", "x-fwd", True),
        ("turn_angle_error", "y-fwd", False),
        ("gyro_scale_asymmetry", "x-fwd", False),
    ],
)
def test_a_step_in_one_turn_is_what_an_effect_of_that_turn_says(name, place, one):
    step = replace(effect("step_in_turn", "gyro"), **of("x-fwd"))
    named = replace(effect(name, "gyro"), **of(place))
    assert causes(step, named) == (
        {name: {"step_in_turn"}} if one else {name: set(), step.cause: set()}
    )


def test_a_step_that_no_effect_names_explains_the_structure_that_its_turn_carries():
    step = replace(effect("step_in_turn", "gyro"), **of("x-fwd"))
    for turn, explained in (("x-fwd", {"unknown_structure"}), ("y-fwd", None)):
        structure = replace(effect("unknown_structure", "gyro", "unknown_structure"), **of(turn))
        assert causes(step, structure).get("step_in_turn") == (explained or set())
        assert len(causes(step, structure)) == (1 if explained else 2)


def test_a_shift_at_the_time_of_a_step_is_that_step():
    step = at(replace(effect("step_in_turn", "gyro"), **of("x-fwd")), 227.15, 0.16, 431)
    assert causes(step, at(effect("mounting_shift", "gyro"), 125, 69, 436)) == {
        "mounting_shift": {"step_in_turn"}
    }
    assert len(causes(step, at(effect("mounting_shift", "gyro"), 25, 9, 436))) == 2


def test_noise_in_a_wrong_unit_is_no_noise_of_its_own():
    """103 times the data sheet's, where all that is read is 102 times too large."""
    unit = finding("quality", "wrong_scale_factor", "accel")
    noise = finding("noise", "noise_above_data_sheet", "accel")
    other = finding("noise", "noise_above_data_sheet", "gyro")
    assert causes(unit, noise) == {"wrong_scale_factor": {"noise_above_data_sheet"}}
    assert len(list(compete([unit, other]))) == 2


@pytest.mark.parametrize(
    ("masked", "turn", "one"),
    [(False, "x-fwd", True), (False, "y-fwd", False), (True, "x-fwd", False)],
)
def test_an_impact_in_a_turn_is_the_step_of_that_turn(masked, turn, one):
    """What is masked is not in the readings any more, so it makes no step."""
    step = replace(effect("step_in_turn", "gyro"), **of("x-fwd"))
    impact = finding("quality", "impact", "gyro", masked=masked, **of(turn))
    assert causes(impact, step) == (
        {"impact": {"step_in_turn"}} if one else {"impact": set(), "step_in_turn": set()}
    )


@pytest.mark.parametrize(("rivals", "explained"), [((RIVAL,), True), ((), False)])
def test_a_count_size_by_axes_that_nobody_knows_is_no_cause(rivals, explained):
    """By hand the angles between rests are those of exchanged axes: gyros read x 0.36 times."""
    swap = finding("quality", "axis_swap", "gyro", 3, repair=APPLIED | {"id": "axes/gyro"})
    swap = replace(swap, rivals=rivals)
    size = finding("gyroscope", "gyro_count_size", "gyro")
    named = {"axis_swap": {"gyro_count_size"}}
    if not explained:  # set right, so that the size is by the right axes
        named = {"axis_swap": set(), "gyro_count_size": set()}
    assert causes(swap, size) == named


@pytest.mark.parametrize(
    ("sensor", "member", "moves", "doubted"),
    [
        ("accel", "table_axis_non_orthogonality", 130.0, {"gyro"}),  # 1.3 mrad
        ("accel", "mounting_shift", None, {"gyro"}),
        ("accel", "table_axis_non_orthogonality", 1.5, set()),  # 15 µrad of 20
        ("accel", "accel_bias_jump", 130.0, set()),
        ("gyro", "mounting_shift", 130.0, set()),
    ],
)
def test_gyros_hold_on_condition_where_attitudes_may_be_wrong(sensor, member, moves, doubted):
    """The cross-axis terms of the gyros take up a wrong attitude, which their residuals lack."""
    accel, gyro = (SimpleNamespace(cross_sigma=sigma) for sigma in (10e-6, 20e-6))
    evidence = Evidence({("accel", ""): accel, ("gyro", ""): gyro}, frozenset(), {})
    structure = effect("unknown_structure", sensor, "unknown_structure", member)
    assert evidence._doubted(structure, moves) == doubted
    each = ExplainedFindings(structure, (structure,))
    cause = Cause((each,), ("accel", "gyro"), "none", "", moves, doubted=frozenset(doubted))
    assert cause.of("accel").condition is None and cause.of("accel").spoils
    assert (cause.of("gyro").condition is not None) == bool(doubted) != cause.of("gyro").spoils


@pytest.mark.parametrize(
    ("state", "complete", "cure"),
    [("rival", False, "left_out"), ("rival", True, "none"), ("applied", False, "repaired")],
)
def test_exchanged_manoeuvres_that_are_not_set_right_are_left_out(state, complete, cure):
    swapped = finding("segment", "manoeuvre_swapped", severity=3)
    row = swapped.row | {"manoeuvre": "y-up"}
    repair = {"state": state, "value": None, "stated": None}
    swapped = replace(swapped, row=row, repair=repair)
    performed = {"y-up": SimpleNamespace(complete=complete)}
    assert Evidence({}, frozenset(), performed)._cure(swapped, (), ())[0] == cure


def test_what_the_campaign_file_confirms_need_not_be_confirmed():
    swapped = finding("segment", "manoeuvre_swapped")
    row = swapped.row | {"action": "or confirm it by accept: [a/b]"}
    for state, said in (("applied", "or confirm it"), ("confirmed", "Nothing more")):
        repair = {"state": state, "id": "a/b"}
        assert replace(swapped, row=row, repair=repair).action.startswith(said)
