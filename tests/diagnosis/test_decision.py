"""Which candidate counts: predicted better, no alarm, carried by no manoeuvre, nothing lost."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.hypotheses import Hypothesis
from stages.diagnosis.causes import NONE, Cause
from stages.diagnosis.decision import alarms_of, decided
from stages.diagnosis.sensor_results import competing
from stages.diagnosis.verdict import verdict

Row = dict[str, Any]


def candidate(method: str = "extended", **changes: Any) -> Row:
    row = {"mount": "", "sensor": "gyro", "method": method, "probability": 1.0}
    row |= {"drop": 35.0, "drop_without_walk": None, "snr_squared": 40.0}
    row |= {"undetermined": 0, "open_form": False, "saturated": False}
    return row | changes


def effect(name: str = "gyro_bias_ramp", carried_by: str | None = None, **changes: Any) -> Row:
    row = {"method": "extended", "effect": name, "carried_by": carried_by}
    return row | {"finding": "criticism/1"} | changes


JOINT = candidate("joint", probability=0.0, drop=None, snr_squared=None)


def test_it_counts_where_others_predict_it_and_nothing_warns():
    decision = decided([JOINT, candidate()], [effect()])
    assert decision.method == "extended"
    for words in ("of the gyros includes", "gyro bias ramp", "falls by 35.00", "would bring 40.00"):
        assert words in decision.reason


@pytest.mark.parametrize(
    ("alarms", "changes", "carried_by", "words"),
    [
        (["gyro_drift"], {}, None, "some findings are not explained"),
        ([], {"drop": -2.0}, None, "grows by 2.0"),
        ([], {"drop": 1.0, "snr_squared": 2.0}, None, "not cross-validatable"),
        ([], {"undetermined": 1}, None, "one parameter would not be determined"),
        ([], {"undetermined": 3}, None, "3 parameters would not be determined"),
        ([], {"open_form": True}, None, "so they would fit any law"),
        ([], {"saturated": True}, None, "none of these predicts another"),
        ([], {}, "x-down", "x-down alone carries gyro bias ramp"),
    ],
)
def test_the_joint_result_stays(alarms, changes, carried_by, words):
    told = [{"cause": cause} for cause in alarms]
    decision = decided([JOINT, candidate(**changes)], [effect(carried_by=carried_by)], told)
    assert decision.method == "joint"
    assert words in decision.reason and "without gyro bias ramp in its model" in decision.reason


def test_an_effect_of_one_manoeuvre_needs_no_other_to_predict_it():
    """A position that is off is free to lean in the model: then it moves no parameter any more."""
    nothing = candidate(drop=0.0, snr_squared=0.0)
    decision = decided([JOINT, nothing], [effect("table_position_error", "y-up")])
    assert decision.method == "extended" and "y-up" in decision.reason
    # A jump half way is carried by none, so others can and must predict it.
    assert decided([JOINT, nothing], [effect("gyro_bias_jump")]).method == "joint"
    # And beside another effect it excuses nothing.
    both = [effect("table_position_error", "y-up"), effect("accel_quadratic")]
    assert decided([JOINT, nothing], both).method == "joint"
    assert decided([JOINT, candidate()], both).method == "extended"


def test_two_levels_within_one_manoeuvre_are_its_own_and_spare_what_others_show():
    """A law of another state that one manoeuvre carries would change all others."""
    levels = effect("gyro_x_telegraph_of_time", "y-up")
    decision = decided([JOINT, candidate()], [levels, effect("gyro_g_sensitivity")])
    assert decision.method == "extended" and not decision.freed
    of_rate = effect("gyro_x_polynomial_of_rate", "y-up")
    assert decided([JOINT, candidate()], [of_rate, effect()]).method == "joint"
    assert decided([JOINT, candidate()], [levels]).freed == {"criticism/1": "y-up"}


def test_what_one_manoeuvre_alone_shows_may_be_its_own_error_whatever_else_it_may_be():
    """A shift after the first rest, or that rest is off: for all others that is the same."""
    rows = [
        JOINT,
        candidate(probability=0.6),
        candidate("member_1", probability=0.3),
        candidate("member_2", probability=0.1),
    ]
    shift = effect("mounting_shift", "x-up")
    off = effect("table_position_error", "x-up", method="member_1")
    another = effect("table_position_error", "x-down", method="member_2")
    decision = decided(rows, [shift, off, another])
    assert (decision.method, decision.freed) == ("member_1", {"criticism/1": "x-up"})
    assert decision.alike == {"extended", "member_1"}  # not of another manoeuvre
    assert competing(rows, decision) == pytest.approx({"member_1": 0.9, "member_2": 0.1})
    assert "Instead of set position that is off it may be shift of the IMU" in decision.reason
    # Half way of the campaign a shift is no single manoeuvre's error.
    assert decided(rows, [effect("mounting_shift"), off, another]).method == "extended"


@pytest.mark.parametrize(
    ("law", "of_law"),
    [
        (effect("accel_quadratic", "y-down"), {}),
        (effect("accel_hysteresis"), {"snr_squared": 1.0}),  # other manoeuvres cannot bear it out
    ],
)
def test_a_law_or_the_own_error_of_a_position_is_the_mean_over_both(law, of_law):
    """A law that fits six positions as well as a bias of one of them changes all of them."""
    rows = [
        JOINT,
        candidate(probability=0.6, **of_law),
        candidate("member_1", probability=0.3),
        candidate("member_2", probability=0.1),
    ]
    own, other = (
        effect("accel_bias_of_position", place, method=f"member_{number}")
        for number, place in ((1, "y-down"), (2, "y-up"))
    )
    decision = decided(rows, [law, own, other])
    assert (decision.method, decision.freed, decision.alike) == ("extended", {}, frozenset())
    assert "one of these, and not which" in decision.reason
    assert decision.reason.count("bias of the accelerometers in one position") == 1
    assert competing(rows, decision) == {"extended": 0.6, "member_1": 0.3, "member_2": 0.1}


def test_a_law_that_other_manoeuvres_bear_out_is_in_the_model_as_ever():
    rows = [JOINT, candidate(probability=0.7), candidate("member_1", probability=0.3)]
    own = effect("accel_bias_of_position", "y-down", method="member_1")
    decision = decided(rows, [effect("accel_quadratic"), own])
    assert decision.method == "extended" and "held-out manoeuvres falls" in decision.reason


def test_what_held_out_manoeuvres_tell_a_little_of_counts_as_much_as_they_tell():
    """A K2 of 80 µg/g²: 3 sigma at most, so that neither result is left out."""
    rows = [
        JOINT,
        candidate(probability=0.9, drop=8.1, snr_squared=8.4),
        candidate("member_1", probability=0.1, drop=7.5, snr_squared=6.4),
    ]
    effects = [effect("accel_quadratic"), effect("accel_hysteresis", method="member_1")]
    decision = decided(rows, effects)
    assert decision.method == "extended" and "the weight 1.7 %" in decision.reason
    # Where no parameter differs there is no mean, and so none is spoken of.
    assert "mean of that with it" in decision.reason
    assert "weight" not in decision.alone and "that with it alone" in decision.alone
    # A normal density of χ² larger by 8.1 is e^4.05 = 57.4 times smaller.
    weights = {"joint": 1 / 58.4, "extended": 0.9 * 57.4 / 58.4, "member_1": 0.1 * 57.4 / 58.4}
    assert competing(rows, decision) == pytest.approx(weights, rel=1e-3)
    enough = decided([JOINT, candidate(drop=8.1, snr_squared=9.1)], [effect()])
    assert competing([JOINT, candidate()], enough) == {"extended": 1.0}
    for changes in ({"drop": 3.9, "snr_squared": 3.9}, {"drop": 2.0, "snr_squared": 8.4}):
        little = decided([JOINT, candidate(**changes)], [effect()])
        assert (little.method, little.joint_share) == ("joint", 0.0)


def test_what_a_random_walk_explains_as_well_is_not_missing_from_the_drop():
    """Of 60 019, which the SNR² of 59 992 expects, a walk of the biases explains all but 96."""
    walked = candidate(drop=96.05, drop_without_walk=60018.9, snr_squared=59991.7)
    reason = decided([JOINT, walked], [effect()]).reason
    assert "hardly bear it out" not in reason
    assert (
        "falls by 60019 against the joint fit without its random walk, of 59992 to be expected"
        in reason
    )
    assert "would explain all but 96.05 of it" in reason
    little = decided([JOINT, candidate(drop=96.05, snr_squared=59991.7)], [effect()]).reason
    assert "0.16 % of what it should be" in little and "random walk" not in little


def unexplained(size: float) -> Row:
    return {"cause": "unexplained", "size": size}


def test_a_little_more_than_noise_widens_the_sigmas_of_effects_that_predict_as_they_should():
    """A lever arm known to 0.01 mm was refused for residuals of 1.2 times noise."""
    decision = decided([JOINT, candidate()], [effect()], [unexplained(1.2)])
    assert (decision.method, decision.widened) == ("extended", 1.2)
    assert "1.2 times as large as noise" in decision.reason
    assert "no finding remains unexplained" not in decision.reason
    for changes, alarms in (
        ({}, [unexplained(2.0)]),
        ({"drop": 15.0}, [unexplained(1.2)]),
        ({"drop": 4.0, "snr_squared": 4.0}, [unexplained(1.2)]),
        ({}, [unexplained(1.2), {"cause": "gyro_drift", "size": 5.0}]),
    ):
        decision = decided([JOINT, candidate(**changes)], [effect()], alarms)
        assert (decision.method, decision.widened) == ("joint", 1.0)
        assert "some findings are not explained" in decision.reason


def test_a_sensor_that_shows_no_effect_keeps_its_result():
    alone = candidate("joint", sensor="accel", drop=None)
    decision = decided([alone], [])
    assert (decision.method, "show no effect" in decision.reason) == ("joint", True)
    assert "sigmas are doubtful" in decided([alone], [], [{"cause": "unexplained"}]).reason
    assert "no joint result" in decided([alone], [], determined=False).reason


def test_the_most_probable_member_competes_and_the_others_are_said():
    rows = [
        JOINT,
        candidate(probability=0.4, drop=-5.0),
        candidate("member_1", probability=0.6),
    ]
    effects = [effect(), effect("gyro_warm_up", method="member_1")]
    decision = decided(rows, effects)
    assert decision.method == "member_1"
    assert "Instead of gyro warm-up it may be gyro bias ramp" in decision.reason


def test_what_is_not_understood_is_an_alarm_of_its_sensor_and_a_random_walk_is_none():
    findings = [
        {"mount": mount, "sensor": sensor, "cause": cause, "verdict": verdict}
        for mount, sensor, cause, verdict in (
            ("", "gyro", "gyro_drift", "unknown_structure"),
            ("", "gyro", "gyro_random_walk", "unknown_structure"),
            ("", "gyro", "unexplained", None),
            ("", "accel", "accel_quadratic", "found"),
            ("lying", "gyro", "table_tilt", "unknown_structure"),
        )
    ]
    assert [r["cause"] for r in alarms_of(findings, "", "gyro")] == ["gyro_drift", "unexplained"]
    assert alarms_of(findings, "", "accel") == []
    assert [row["cause"] for row in alarms_of(findings, "lying", "gyro")] == ["table_tilt"]


def test_of_what_held_out_manoeuvres_hardly_bear_out_the_share_is_said():
    """229 of 12,030: 1.9 %."""
    little = decided([JOINT, candidate(drop=229.0, snr_squared=12030.0)], [effect()])
    assert little.method == "extended" and "That is 1.9 % of what it should be" in little.reason
    much = decided([JOINT, candidate(drop=9000.0, snr_squared=12030.0)], [effect()])
    assert "hardly bear it out" not in much.reason


def test_the_verdict_names_every_member_of_a_class():
    names = ["accel_scale_asymmetry", "accel_quadratic", "accel_bias_jump", "accel_hysteresis"]
    row = {"size": 1.0, "unit": "1", "severity": 2, "axis": None, "sensor": "accel", "mount": ""}
    row |= {"manoeuvre": None}
    found = Hypothesis(
        "1", "criticism", names[0], row, verdict="one_of_class", members=tuple(names)
    )
    cause = Cause((ExplainedFindings(found, ()),), ("accel",), NONE, "", None)
    assert cause.name.count(" or ") == 3 and "accelerometer hysteresis" in cause.name


def tilting(size: float) -> Cause:
    """A rest of unknown attitude that tilts by so many ″ while it is recorded."""
    row = {"size": size, "unit": "″", "severity": 2, "axis": None, "sensor": None}
    row |= {"manoeuvre": None, "log": None, "mount": ""}
    tilts = Hypothesis("segment/tilt", "segment", "table_moving", row)
    both = ("gyro", "accel")
    return Cause((ExplainedFindings(tilts, ()),), both, NONE, "", None)


@pytest.mark.parametrize(
    ("sensor", "size", "covers", "said"),
    [
        ("accel", 1069.0, True, "(harmless)"),  # g θ²/2 is 1.3 × 10⁻⁴ m/s², 0.38 σ
        ("accel", 4000.0, False, "(4000″, not removed, its influence not known)"),
        ("gyro", 1069.0, True, "(1070″, not removed; the sigmas include by how much the man"),
        ("gyro", 1069.0, False, "(1070″, not removed, its influence not known)"),
    ],
)
def test_a_verdict_says_how_large_what_is_not_removed_is(sensor, size, covers, said):
    """`imu_tk_xsens`: the bias of the accelerometers is known to 3.5 × 10⁻⁴ m/s²."""
    result = SimpleNamespace(
        sensor=sensor,
        undetermined=[],
        matrix_sigmas={},
        chosen=SimpleNamespace(method="free_positions"),
        bias_sigma=3.5e-4,
        covers_misfit=covers,
    )
    told = verdict(result, [tilting(size)])
    assert told.verdict == "usable_within_limits" and said in told.sentence


def test_what_of_the_matrix_is_hardly_known_is_said_of_a_usable_result():
    """A cross term to 1100″ is said; one to 100″ and a scale factor to 0.1 % are not."""
    known = {"scale_x": 1e-3, "cross_xy": np.radians(100 / 3600), "cross_yz": np.radians(0.306)}
    result = SimpleNamespace(sensor="gyro", undetermined=[], matrix_sigmas=known)
    told = verdict(result, [])
    assert told.verdict == "usable_within_limits"
    assert told.sentence == "Gyros: usable. Known to 0.31° (σ) only: m_yz."
    del known["cross_yz"]
    assert verdict(result, []).verdict == "usable"


def test_a_slip_in_a_turn_says_something_else_of_all_that_follows():
    """Though one turn alone shows it: so it competes with the error of that turn's angle."""
    rows = [JOINT, candidate(probability=0.9), candidate("member_1", probability=0.1)]
    off = effect("turn_angle_error", "x-forward")
    slip = effect("mounting_slip", "x-forward", method="member_1")
    decision = decided(rows, [off, slip])
    assert decision.freed == {"criticism/1": "x-forward"}
    assert decision.alike == {"extended"}
