"""A sentence for each sensor, and every cause once, on a card that answers everything."""

from __future__ import annotations

import re
from html import unescape
from typing import Any

import pandas as pd
import pytest

from inertial import tables
from stages.report.sections import certificate, verdict
from stages.report.words import how_large, size_in_words
from tests.report import synthetic, synthetic_faults, synthetic_unmodelled
from tests.report.synthetic_diagnosis import SENTENCES
from tests.report.synthetic_values import GAP_FINDING, rows_as

CARD = re.compile(
    r'<article class="finding[^"]*" id="cause/diagnosis/([^"]+)">(.*?)</article>', re.S
)
QUESTIONS = ["How sure", "How large", "What it does", "What was done", "What to do"]


def page_one(made: dict[str, Any]) -> str:
    """The certificate and the cards, as HTML."""
    sections = (certificate.SECTION, verdict.SECTION)
    return "".join(synthetic.section_on(made, section) for section in sections)


def cards(made: dict[str, Any]) -> dict[str, str]:
    """The cards by the finding that names the cause, in their order."""
    return dict(CARD.findall(page_one(made)))


def answers(card: str) -> dict[str, str]:
    found = re.findall(r"<dt>([^<]+)</dt><dd>(.*?)</dd>", card, re.S)
    return {name: unescape(text) for name, text in found}


def as_text(made: dict[str, Any]) -> str:
    """The verdict as plain text in one line, built from the tables that page one declares."""
    own = {name: made[name] for name in (*verdict.SECTION.reads, "provenance")}
    return " ".join(verdict.as_text(synthetic.tables_of(own)).split())


def test_each_sensor_has_its_sentence_on_the_page_and_in_the_text() -> None:
    made = synthetic.brief()
    listed = re.findall(r"<li>([^<]*)</li>", page_one(made))
    assert listed[: len(SENTENCES)] == [*SENTENCES.values()]
    for sentence in SENTENCES.values():
        assert as_text(made).count(sentence) == 1


def test_a_sensor_that_is_not_recorded_is_not_the_verdict_of_the_campaign() -> None:
    made = synthetic.brief()
    made["verdict"] = made["verdict"].assign(
        verdict=made["verdict"]["sensor"].map({"accel": "usable", "gyro": "not_usable"})
    )
    alone = made["verdict"].assign(recorded=made["verdict"]["sensor"] == "accel")
    assert "Verdict: usable All" in as_text(made | {"verdict": alone})
    assert "Verdict: not usable" in as_text(made)


def test_each_cause_has_one_card_that_answers_every_question() -> None:
    made = synthetic.brief()
    found = cards(made)
    assert [*found] == [  # what is in the model, what is interpolated, what is harmless
        "criticism/gyro_g_sensitivity",
        GAP_FINDING,
        "criticism/oscillation",
    ]
    for card in found.values():
        assert [name for name in answers(card) if name in QUESTIONS][:1] == ["How sure"]
    told = answers(found["criticism/gyro_g_sensitivity"])
    assert [*told] == [*QUESTIONS[:4], "Gain", "What to do"]
    assert "SNR 77" in told["How sure"]
    # 6.9e-7 (rad/s)/(m/s²) · 9.80665 m/s² · 3600 s · 180°/π = 1.396 °/h/g
    assert told["How large"] == "1.396 ± 0.028 °/h/g"
    assert "up to 4.0 σ" in told["What it does"]
    assert told["Gain"] == "χ² of held-out manoeuvres is lower by 12070."


def test_consequences_stand_on_the_card_of_their_cause_and_have_none_of_their_own() -> None:
    made = synthetic.brief()
    found = cards(made)
    assert answers(found[GAP_FINDING])["Therefore"] == "Incomplete turn (1)."
    assert "Therefore" not in answers(found["criticism/oscillation"])  # the same, heard twice
    assert "Of z-backward 240.2°" not in page_one(made)
    assert len(found) == 3 < sum(len(made[f"{of}_findings"]) for of in ("quality", "criticism")) + 1


def test_what_was_set_right_states_its_gain_and_its_condition() -> None:
    told = answers(cards(synthetic_faults.faulty())["quality/gravity_error"])
    assert told["Valid if"] == "Gravity is that of the formula."
    assert told["Gain"].startswith("With it 6 of 6")
    assert "Not set right, it would shift a parameter by up to 240 σ." in told["What it does"]


def test_repairs_of_one_kind_are_named_once_and_each_says_what_would_be_true() -> None:
    made = synthetic_unmodelled.of_a_class()
    made["cause_members"]["member"] = "exchanged_manoeuvres"
    made["cause_members"]["condition"] = ["y-up and y-down", "y-up and z-up"]
    card = cards(made)["criticism/accel_quadratic"]
    assert "<strong>Exchanged manoeuvres · accelerometer</strong>" in card
    assert "distinguish: y-up and y-down, y-up and z-up (SNR" in answers(card)["How sure"]


def test_a_class_names_its_members_in_title_and_certainty() -> None:
    made = synthetic_unmodelled.of_a_class()
    card = cards(made)["criticism/accel_quadratic"]
    assert "<strong>Accelerometer quadratic term or lever arm</strong>" in card
    assert "accelerometer quadratic term, lever arm (SNR 12" in answers(card)["How sure"]
    made["cause_members"]["probability"] = [0.75, 0.25]
    shares = answers(cards(made)["criticism/accel_quadratic"])["How sure"]
    assert "quadratic term with probability 75 %, lever arm with probability 25 %" in shares
    made["cause_members"]["probability"] = [1.0, 5e-14]
    sure = answers(cards(made)["criticism/accel_quadratic"])["How sure"]
    assert sure.startswith("By far the likeliest of a class")
    assert "with probability > 99.9 %, lever arm with probability < 0.1 %" in sure


def test_the_worst_comes_first_and_what_is_harmless_last() -> None:
    made = synthetic_faults.faulty()
    grades = [re.findall(r'class="grade">([^<]+)<', card)[0] for card in cards(made).values()]
    order = ["set right", "in the model", "interpolated", "not removed", "harmless"]
    assert [*dict.fromkeys(grades)] == order


def test_what_spoils_a_result_is_red_and_comes_before_all_else() -> None:
    made = synthetic_faults.faulty()
    made["verdict"]["verdict"] = ["not_usable", "usable"]  # of gyros, of accelerometers
    page = page_one(made)
    tones = re.findall(r'<article class="finding ([a-z]*)" id="cause/diagnosis/([^"]+)"', page)
    red = [name for tone, name in tones if tone == "poor"]
    assert red == [name for _, name in tones][: len(red)]
    assert "quality/saturation/y-forward.asc/gyro_y" in red
    assert "quality/spike/x-up.asc/accel_x" not in red


def test_the_text_says_what_the_cards_say() -> None:
    made = synthetic_faults.faulty()
    text = as_text(made)
    for row in made["causes"].itertuples():
        assert text.count(row.sentence) >= 1
    for card in cards(made).values():
        for name, answer in answers(card).items():
            assert f"{name}: {' '.join(answer.split())}" in text


@pytest.mark.parametrize(
    ("given", "word"),
    [
        (("usable", "usable"), "Usable"),
        (("usable", "usable_within_limits"), "Usable, with departures from the ideal"),
        (("on_condition", "usable_within_limits"), "Usable on condition"),
        (("on_condition", "not_usable"), "Not usable"),
    ],
)
def test_the_verdict_is_that_of_the_worst_sensor(given: tuple[str, str], word: str) -> None:
    made = synthetic.brief()
    made["verdict"]["verdict"] = given
    assert f"<strong>{word}</strong>" in page_one(made)
    assert f"Verdict: {word.lower()}" in as_text(made)


def test_a_card_leads_to_what_shows_its_cause() -> None:
    leads = {
        name: re.findall(r'<a href="#([^"]+)"', card)
        for name, card in cards(synthetic.brief()).items()
    }
    assert leads == {
        "criticism/gyro_g_sensitivity": ["effect/criticism/gyro_g_sensitivity"],
        GAP_FINDING: [f"evidence/diagnosis/{GAP_FINDING}"],
        "criticism/oscillation": [
            "effect/criticism/oscillation",
            "evidence/diagnosis/criticism/oscillation",
        ],
    }


def test_a_clean_campaign_has_no_card() -> None:
    made = synthetic.brief()
    for name in ("causes", "cause_members", "consequences"):
        made[name] = made[name].iloc[:0]
    assert not cards(made)
    assert "How sure" not in as_text(made)


@pytest.mark.parametrize(
    ("cause", "size", "sigma", "unit", "words"),
    [
        ("spike", 0.6, None, "rad/s", "34.38 °/s"),  # 0.6 · 180/π
        ("gyro_bias_jump", 9.7e-6, 1e-6, "rad/s", "2.00 ± 0.21 °/h"),  # · 180/π · 3600
        ("gravity_error", 0.013, None, "m/s²", "1326 µg"),  # 0.013 / 9.80665e-6 = 1325.6
        ("spike", 60.0, None, "m/s²", "60.00 m/s²"),
        ("wrong_scale_factor", 0.017453, None, "1", "0.01745 (ratio)"),
        ("gyro_scale_asymmetry", 2e-4, 1e-6, "1", "200.0 ± 1.0 ppm"),
        ("incomplete_turn", 2.09, None, "rad", "119.7°"),
        ("gap", 1197.0, None, "samples", "1\u202f197 samples"),
        ("sign_flip", 1.0, None, "manoeuvres", "1 manoeuvre"),
        ("unknown_structure", 9.835, None, "sigma", "9.84 σ"),
    ],
)
def test_sizes_are_in_the_units_of_the_laboratory(
    cause: str, size: float, sigma: float | None, unit: str, words: str
) -> None:
    row = {"cause": cause, "size": size, "sigma": sigma, "unit": unit}
    assert size_in_words(row) == words


def test_of_several_runs_the_size_is_that_of_the_longest() -> None:
    """`mpu6050_cuyo`: 18 readings in 3 places, and the size of the finding is 10."""
    row = {"cause": "saturation", "size": 10.0, "sigma": None, "unit": "samples", "count": 3}
    assert how_large(row) == "10 samples in the longest of 3 places"
    assert how_large(row | {"count": 1}) == "10 samples"
    assert how_large(row | {"cause": "dead_axis"}) == "10 samples"
    assert how_large(row | {"cause": "latitude_sign"}) is None  # it is there, or it is not


def test_a_storm_of_equal_causes_of_one_card_stands_at_no_single_place() -> None:
    made = synthetic.brief()
    spike = {"id": "diagnosis/quality/spike", "cause": "spike", "verdict": "found", "count": 120}
    spike |= {"log": "x-up.asc", "sensor": "gyro", "cure": "masked", "sentence": "120 spikes."}
    spike |= {"unit": "rad/s", "consequence": "None.", "done": "Masked.", "action": "Look."}
    made["causes"] = pd.concat([made["causes"], rows_as(tables.CAUSES, [spike])])
    card = cards(made)["quality/spike"]
    assert "<strong>Spike · gyro</strong>" in card
    assert "120 spikes." in card  # and nowhere else how many
    assert card.count("120") == 1
