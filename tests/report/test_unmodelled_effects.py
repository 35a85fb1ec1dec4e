"""Unmodelled effects: each finding of criticism with what a reader asks, in the right words."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import pandas as pd
import pytest

from inertial import tables
from inertial.effects import CATALOGUE
from stages.report.sections import unmodelled_effects
from stages.report.sections.effect_sentences import TOO_LARGE, Tested, observable, possible
from stages.report.sections.effect_tables import THERE_OR_NOT, detection_limits
from tests.report import synthetic, synthetic_unmodelled
from tests.report.synthetic_diagnosis import diagnosed
from tests.report.synthetic_values import Held, rows_as

CAUSE = re.compile(r'<article class="finding cause[^"]*" id="effect/([^"]+)">(.*?)</article>', re.S)


@cache
def of(make: Callable[..., dict[str, Any]], *arguments: str) -> str:
    """The sections of a synthetic campaign."""
    return on(make(*arguments))


def on(made: dict[str, Any]) -> str:
    sections = (unmodelled_effects.SECTION, unmodelled_effects.EFFECTS)
    return synthetic.section_on(made, *sections)


def blocks(html: str) -> dict[str, str]:
    """Each block by the identifier of its finding, as HTML with single spaces, in its order."""
    return {name: " ".join(block.split()) for name, block in CAUSE.findall(html)}


def section(html: str) -> str:
    """The section without marks."""
    return " ".join(re.sub(r"<[^>]+>", " ", html).split())


def demo() -> dict[str, str]:
    return blocks(of(synthetic.brief))


def no_name() -> dict[str, str]:
    return blocks(of(synthetic_unmodelled.of_no_name, "angle", "change"))


def test_what_is_identified_says_how_sure_it_is_and_what_it_gains() -> None:
    html = demo()["criticism/gyro_g_sensitivity"]
    assert (
        "Identified: no other effect of the catalogue has the same signature in these data." in html
    )
    assert "Signal-to-noise ratio: 77.0. Probability under noise alone: p &lt; 10⁻¹²." in html
    assert "χ² of the gyros falls by 12 070 of 12 897, which captures 99." in html
    assert "mass unbalance" not in html.partition("Certainty")[0]  # the sentence is criticism's own


def test_what_changes_most_is_stated_in_the_units_of_the_laboratory() -> None:
    html = demo()["criticism/gyro_g_sensitivity"]
    # 1.3e-6 rad/s are 0.2681 °/h; four sigma of 2.1e-8 rad/s more are 0.2855 °/h
    said = "Of all parameters, bias x of the gyro changes most: from 0.2681 ± 0.0043 to 0.2855"
    assert said in html
    assert "σ of the joint fit" not in html


def test_residuals_stand_before_and_after() -> None:
    html = demo()["criticism/gyro_g_sensitivity"]
    assert html.count('role="img"') == 1
    assert "without (hollow) and with effects in the model (filled)" in html


def test_an_effect_in_the_model_of_the_result_is_shown_with_its_numbers() -> None:
    html = demo()["criticism/gyro_g_sensitivity"]
    assert "as they were detected; the result does not contain them" in html
    made = synthetic.brief()
    result = made["result"]
    gyro = result[result["sensor"] == "gyro"].iloc[[0]]
    of_effect = gyro.assign(
        id="diagnosis/gyroscope/gyro_g_sensitivity.g_yy",
        effect="gyro_g_sensitivity",
        parameter="gyro_g_sensitivity.g_yy",
        value=-4.92e-7,
        sigma=1.4e-8,
    )
    made["result"] = pd.concat([result, of_effect], ignore_index=True)
    html = blocks(on(made))["criticism/gyro_g_sensitivity"]
    assert "Gyro g-sensitivity: the parameters beyond 3 σ, by the result." in html
    # 4.92e-7 (rad/s)/(m/s²) · 206 264.8 · 9.80665
    (row,) = re.findall(r'<tr id="criticism/gyro_g_sensitivity/.*?</tr>', html)
    assert "−0.995" in row and "0.028" in row


def test_an_oscillation_is_shown_as_s0_shows_it() -> None:
    html = demo()["criticism/oscillation"]
    shown = "x gyro in x-forward, a turn about x; y gyro in y-forward, a turn about y; x gyro in"
    assert shown in html
    assert html.count("20.000 Hz, 0.573 °/s") == 2
    assert html.count("no significant line") == 1


def test_an_oscillation_says_in_numbers_what_it_costs() -> None:
    html = demo()["criticism/oscillation"]
    # 0.01 rad/s / (2π · 20 Hz) = 7.958e-5 rad, 16.4 arcsec; against 2π rad 12.7 ppm
    assert "A/(2πf), it is 16.4 arcsec: 13 ppm of 360°" in html
    assert "the σ of the scale factor of the x gyro is 2.2 ppm" in html
    assert "fall from 0.379 °/s to 0.00201 °/s rms in held-out turns" in html


def test_the_clearest_comes_first_and_leads_to_the_card_of_its_cause() -> None:
    assert [*demo()] == ["criticism/gyro_g_sensitivity", "criticism/oscillation"]
    card = "cause/diagnosis/criticism/oscillation"
    assert f'href="#{card}"' in demo()["criticism/oscillation"]


def test_a_class_names_its_members_and_the_manoeuvre_that_would_split_it() -> None:
    made = of(synthetic_unmodelled.of_a_class)
    html = blocks(made)["criticism/accel_quadratic"]
    assert "cannot distinguish accelerometer quadratic term and lever arm." in html
    assert "Lever arm (the accelerometers stand beside the axis of the table)." in html
    assert (
        "Rest also with two axes at 45° to the vertical: expected to distinguish them at 24 σ."
        in html
    )
    # 2e-5 (m/s²)/(m/s²)² are 196 µg/g²
    assert re.search(r"196\.1.*±.*3\.9.*µg/g²", html)
    said = "Detected: accelerometer quadratic term or lever arm, which this campaign cannot"
    assert said in section(made)


def test_an_effect_that_was_taken_for_a_position_that_is_off_says_so() -> None:
    made = synthetic_unmodelled.of_a_class()
    score = made["scores"].iloc[1:2].assign(effect="table_position_error", p_value=0.44)
    made["scores"] = pd.concat([made["scores"], score])
    off = {"id": "accelerometer/table_position_error/z-down", "cause": "table_position_error"}
    off |= {"sensor": "accel", "unit": "rad", "manoeuvre": "z-down", "count": 1, "severity": 3}
    off |= {"sentence": "It is off.", "consequence": "It matters.", "action": "Set it again."}
    made["accelerometer_findings"] = rows_as(tables.FINDINGS, [off])
    html = blocks(on(made | diagnosed(made)))["criticism/accel_quadratic"]
    assert "position error in z-down; with the effect in the model no position error is" in html


def test_a_structure_without_a_name_comes_before_what_it_is_consistent_with() -> None:
    assert [*no_name()] == [
        "criticism/unknown_structure/gyro",
        "criticism/gyro_bias_jump",
        "criticism/gyro_random_walk",
    ]
    html = no_name()["criticism/unknown_structure/gyro"]
    assert "Not identified: no effect of the catalogue explains this structure." in html
    assert html.count('role="img"') == 3  # what is left of each manoeuvre, and two tests that fire
    assert "x gyro against the angle of the table: points ± σ" in html
    assert "against a change in time (at 20.0 min)" in html
    for words in ("Angle of the table, °", "Time, min", "Residual, °/h"):
        assert words in html


def test_what_is_only_consistent_is_never_said_to_be_detected() -> None:
    text = section(of(synthetic_unmodelled.of_no_name, "angle", "change"))
    assert "Detected:" not in text
    assert "The residuals of the gyros have a structure that is not identified." in text
    assert "Consistent with the data, but not identified: gyro bias jump." in text
    assert "The biases of the gyros follow a random walk." in text
    jump = no_name()["criticism/gyro_bias_jump"]
    assert "Consistent with the data, but not identified: the name is not certain." in jump
    assert "changes most" not in jump
    walk = no_name()["criticism/gyro_random_walk"]
    assert "other slow changes have much the same signature" in walk
    assert "<svg" not in walk
    assert 'href="#effect/criticism/unknown_structure/gyro">' in walk  # where its picture is


def test_six_tests_are_a_line_where_none_is_and_a_table_where_one_is_significant() -> None:
    silent = section(of(synthetic_unmodelled.without_effects))
    smallest = "smallest p = 0.090 after correction for the search (time, x gyro)"
    assert f"none is significant, {smallest}" in silent
    # Five were made: the temperature is not recorded.
    made = "against time, the angle of the table, the rate of the turns, the attitude and a change"
    assert f"were tested for structure {made}" in silent
    assert "Not tested against the temperature, which the recording does not contain." in silent
    firing = section(of(synthetic_unmodelled.of_no_name, "change"))
    assert "none is significant" not in firing
    assert "A change in time x gyro at 20.0 min 75.00 1 × 10⁻⁹ significant" in firing
    assert "The temperature — — — — not recorded" in firing


def test_what_nothing_explains_is_a_block_too() -> None:
    made = of(synthetic_unmodelled.unexplained)
    html = blocks(made)["criticism/unexplained/accel"]
    assert "Unexplained residuals of the accelerometers" in html
    assert "Not explained by any effect of the catalogue." in html
    assert "exceed the noise, which no known effect explains" in section(made)


def test_a_manoeuvre_that_would_not_split_a_class_is_not_recommended() -> None:
    made = synthetic_unmodelled.of_a_class()
    made["criticism_findings"]["split_snr"] = 0.0013
    html = blocks(on(made))["criticism/accel_quadratic"]
    assert "No manoeuvre considered would." in html
    assert "rest also with two axes" not in html
    made["criticism_findings"]["split_snr"] = 1.3
    html = blocks(on(made))["criticism/accel_quadratic"]
    assert "No manoeuvre considered would; the best, rest also with two axes" in html
    assert "expected to distinguish" not in html


def test_a_ripple_is_shown_against_the_angle_of_the_table() -> None:
    made = synthetic.brief()
    turn = made["simulated"].frame["manoeuvre"].str.contains("forward")
    made["simulated"] = Held(made["simulated"].frame[turn])
    findings = made["criticism_findings"]
    findings[["id", "cause"]] = findings[["id", "cause"]].replace(
        "oscillation", "table_ripple", regex=True
    )
    for name in ("scores", "effects", "members"):
        made[name] = made[name].replace("oscillation", "table_ripple", regex=True)
    html = blocks(on(made | diagnosed(made)))["criticism/table_ripple"]
    assert "z gyro in z-forward" in html
    assert "Angle turned, °" in html
    assert "As an angle, A/(2πf)" not in html


def test_a_walk_that_may_be_an_effect_is_one_of_a_class() -> None:
    made = synthetic_unmodelled.of_no_name()
    walk = made["criticism_findings"].iloc[:1].assign(verdict="one_of_class")
    ramp = {"finding": "criticism/gyro_random_walk", "mount": "", "rank": 2}
    ramp["effect"] = "gyro_bias_ramp"
    made["members"] = pd.concat([made["members"], rows_as(tables.MEMBERS, [ramp])])
    made |= {"criticism_findings": walk}
    page = on(made | diagnosed(made))
    html = blocks(page)["criticism/gyro_random_walk"]
    assert "cannot distinguish random walk of the gyro biases and gyro bias ramp." in html
    assert ">one of a class<" in html
    said = "follow a random walk or gyro bias ramp, which this campaign cannot distinguish."
    assert said in section(page)


@pytest.mark.parametrize(
    ("effect", "unit", "limit", "shown"),
    [
        ("earth_rate_omitted", "1", 0.8, ("would be noticed", "", "", "")),
        ("latitude_sign", "1", 1.2, ("would not be noticed", "", "", "")),
        ("gyro_dead_band_x", "1", 0.019, ("1.9", "", "%", "s")),
        ("gyro_dead_band_x", "1", 1.7, ("not detectable here", "", "", "")),
        ("heading_error", "rad", 3.5, ("not detectable here", "", "", "")),
    ],
)
def test_a_limit_is_no_number_beyond_what_is_possible(effect, unit, limit, shown) -> None:
    score = {"effect": effect, "p_value": 1.0, "sentence": "", "finding": None}
    row = {"effect": effect, "mount": "", "parameter": "s", "unit": unit, "reason": "visible"}
    row |= {"limit": limit, "smallest": limit, "largest": limit, "remark": None}
    row |= {"moves": 2.0, "moved_sensor": "gyro", "moved_parameter": "bias_x"}
    table, *_others = detection_limits([row], [Tested(score, (), "")])
    assert table.rows[0].cells[1:5] == shown


def test_an_effect_beyond_gravity_is_not_observable_and_not_undetected() -> None:
    """The jump of `mpu6050_cuyo`, 10 rests by hand: 5.1 g, a shift of 10000 σ, of ±2 g sensors."""
    score = {"effect": "accel_bias_jump", "p_value": 1.0, "sentence": "", "finding": None}
    row = {"effect": "accel_bias_jump", "mount": "", "unit": "m/s²", "reason": "visible"}
    row |= {"remark": None, "explanation": None, "moved_sensor": "accel"}
    rows = [
        row
        | {"parameter": f"b_{axis}", "limit": limit, "smallest": least, "largest": 49.9}
        | {"moves": moves, "moved_parameter": f"bias_{axis}"}
        for axis, limit, least, moves in (("x", 3.1, 0.41, 128.0), ("y", 36.1, 10.6, 10161.0))
    ]
    seen, not_seen = detection_limits(rows, [Tested(score, (), "")])
    name, worst, best, unit, parameter, meaning, moves, *_others = seen.rows[0].cells
    assert name == "Accelerometer bias jump (b_x)"
    assert [worst, best, unit] == ["not detectable here", "42000", "µg"]
    assert [parameter, meaning] == ["b_x", "jump of the bias of the x accelerometer"]
    assert moves == "130"
    assert not_seen.rows[0].cells == (f"{TOO_LARGE}", "Accelerometer bias jump (b_y).")
    assert observable(rows, "visible") and not observable(rows[1:], "visible")
    square = row | {"parameter": "k", "unit": "(m/s²)/(m/s²)²", "smallest": None}
    assert not possible(square | {"limit": 0.0601})  # 0.59 g/g²
    assert possible(square | {"limit": 0.0034})
    gyro = row | {"parameter": "b", "unit": "rad/s", "smallest": None, "limit": 5.0}
    assert possible(gyro) and not possible(gyro | {"full_scale": 4.4})


def test_what_an_undetected_effect_moves_stands_beside_its_limit() -> None:
    score = {"effect": "lever_arm", "p_value": 1.0, "sentence": "", "finding": None}
    row = {"effect": "lever_arm", "mount": "", "parameter": "r_x", "unit": "m", "limit": 1e-3}
    row |= {"reason": "visible", "smallest": 1e-3, "largest": 1e-3, "remark": None}
    rows = [
        row | {"moves": moves, "moved_sensor": "accel", "moved_parameter": parameter}
        for moves, parameter in ((2.04, "bias_x"), (3.31, "cross_yz"))
    ]
    table, *_others = detection_limits(rows, [Tested(score, (), "")])
    assert table.rows[0].cells[6:8] == ("3.3", "m_yz (accelerometer)")
    assert "external reliability" in str(table)


def test_effects_that_are_there_or_not_have_no_other_size() -> None:
    """All that have one value alone, and what can be left out as a whole."""
    single = {name for name, effect in CATALOGUE.items() if effect.only is not None}
    assert single | {"earth_rate_omitted"} == THERE_OR_NOT
