"""What a certificate states, conformity by JCGM 106, and where both stand in the report."""

import re

import chain
import numpy as np
import pytest
from scipy import stats

from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from stages.diagnosis.conformity import (
    CONFORMS,
    DOES_NOT_CONFORM,
    GUARD_BAND,
    NOT_SHOWN,
    SIMPLE_ACCEPTANCE,
    conformity_rows,
    decision,
)
from stages.plan.certificate import Statements
from stages.report.sections.certificate import SECTION
from stages.report.sections.certified_values import _risk
from tests.report.synthetic import campaign, section_on

CAMPAIGN = """
laboratory: Inertial laboratory
operator: the night shift
date: "2026-11-02"
certificate:
  number: "2026-17"
  customer: {name: A customer}
  tolerances: {decision_rule: simple_acceptance, gyro: {bias_deg_h: 3.6, scale_ppm: 500}}
"""
LABORATORY = """
laboratory: {name: Another name, address: "1 Table Road"}
number: "never used"
standards: [{quantity: angle, name: Table, certificate: "A-1", valid_until: "2027-01-01"}]
"""


def statements(folder, campaign=CAMPAIGN, laboratory=LABORATORY, demanded="as_stated"):
    for name, text in (("campaign.yaml", campaign), ("laboratory.yaml", laboratory)):
        (folder / name).write_text(text)
    return Statements(YamlFile(folder / "campaign.yaml"), [folder / "laboratory.yaml"], demanded)


def test_the_campaign_states_first_then_the_laboratory(tmp_path):
    items = {row["item"]: row for row in statements(tmp_path).items}
    told = {name: (row["text"], row["file"]) for name, row in items.items() if row["file"]}
    assert told == {
        "number": ("2026-17", "campaign.yaml"),
        "laboratory.name": ("Inertial laboratory", "campaign.yaml"),
        "laboratory.address": ("1 Table Road", "laboratory.yaml"),
        "customer.name": ("A customer", "campaign.yaml"),
        "calibrated": ("2026-11-02", "campaign.yaml"),
        "calibrated_by": ("the night shift", "campaign.yaml"),
    }


def test_tolerances_are_in_si(tmp_path):
    bias, scale = statements(tmp_path).tolerances()
    assert (bias["sensor"], bias["kind"], bias["unit"]) == ("gyro", "bias", "rad/s")
    assert bias["limit"] == pytest.approx(np.radians(1e-3))  # 3.6 °/h
    assert scale["limit"] == pytest.approx(500e-6)
    assert bias["decision_rule"] == "simple_acceptance"


def test_a_strict_laboratory_refuses_what_is_not_stated(tmp_path):
    with pytest.raises(Refusal) as refused:
        statements(tmp_path, demanded="strict")
    assert "customer.address" in refused.value.found
    assert "item.firmware" not in refused.value.found


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ("  costumer: {name: A customer}", "line 6, certificate.costumer"),
        ('  issued: "yesterday"', "line 6, certificate.issued"),
        ("  tolerances: {gyro: {bias_deg_h: -1}}", "certificate.tolerances.gyro.bias_deg_h"),
    ],
)
def test_a_mistake_is_refused_with_its_line(tmp_path, line, place):
    with pytest.raises(Refusal) as refused:
        statements(tmp_path, 'date: "2026-11-02"\n\n\n\ncertificate:\n' + line + "\n")
    assert refused.value.place.endswith(place)


# ---- JCGM 106:2012


@pytest.mark.slow
def test_a_guard_band_of_u_leaves_one_false_acceptance_in_44_at_worst():
    """A truth at its limit is the worst: P(y ≤ T − 2 σ) = Φ(−2) = 2.275 %."""
    random = np.random.default_rng(7)
    limit, sigma, draws = 1.0, 0.1, 10_000
    for truth in (1.0, 1.05, -1.0):
        read = truth + sigma * random.normal(size=draws)
        made = [decision(y, sigma, limit, GUARD_BAND).statement for y in read]
        wrong = made.count(CONFORMS)
        assert stats.binomtest(wrong, draws, 0.02275, "greater").pvalue > 1e-3
    assert stats.binomtest(wrong, draws, 0.02275).pvalue > 1e-3  # −1.0, at the limit


@pytest.mark.slow
def test_the_stated_risk_is_how_often_statements_are_wrong():
    """Of a truth of which nothing is known, so of a uniform one over more than its limits."""
    random = np.random.default_rng(8)
    limit, sigma = 1.0, 0.4
    truth = random.uniform(-4, 4, size=10_000)
    for rule in (GUARD_BAND, SIMPLE_ACCEPTANCE):
        made = [
            decision(y, sigma, limit, rule) for y in truth + sigma * random.normal(size=len(truth))
        ]
        for said, is_wrong in ((CONFORMS, np.abs(truth) > limit), (DOES_NOT_CONFORM, None)):
            wrong = np.abs(truth) <= limit if is_wrong is None else is_wrong
            own = [i for i, one in enumerate(made) if one.statement == said]
            stated = np.array([made[i].risk for i in own])
            scatter = np.sqrt(np.sum(stated * (1 - stated)))
            assert wrong[own].sum() == pytest.approx(stated.sum(), abs=4 * scatter)


def test_between_both_nothing_is_shown():
    """JCGM 106 tells acceptance and rejection apart only beyond the guard band."""
    assert decision(0.79, 0.1, 1.0, GUARD_BAND).statement == CONFORMS
    assert decision(0.95, 0.1, 1.0, GUARD_BAND).statement == NOT_SHOWN
    assert decision(-1.21, 0.1, 1.0, GUARD_BAND).statement == DOES_NOT_CONFORM
    assert decision(0.95, 0.1, 1.0, SIMPLE_ACCEPTANCE).statement == CONFORMS
    assert decision(1.0, 0.1, 1.0, SIMPLE_ACCEPTANCE).risk == pytest.approx(0.5)


@pytest.mark.slow
def test_a_campaign_with_tolerances_is_assessed(tmp_path):
    """Biases of 5, −7 and 0 °/h against 1 °/h; their sigmas are 0.1 °/h."""
    document = chain.short()
    document["campaign"]["certificate"] = {"tolerances": {"gyro": {"bias_deg_h": 1}}}
    document["truth"]["gyro"]["bias_rad_s"] = [2.42e-5, -3.39e-5, 0.0]
    chain.simulate(document, tmp_path / "raw")
    rows = chain.run(tmp_path / "raw", tmp_path / "derived", "diagnosis")["diagnosis/conformity"]
    assert [*rows["quantity"]] == ["bias_x", "bias_y", "bias_z"]
    assert [*rows["statement"]] == [DOES_NOT_CONFORM, DOES_NOT_CONFORM, CONFORMS]
    assert rows["risk"].max() < 1e-3


def test_nothing_conforms_of_a_sensor_that_is_not_usable():
    """A value far within its limit says nothing where a cause that is not removed moves it."""
    row = {"sensor": "gyro", "mount": "", "effect": None, "parameter": "bias_x"}
    result = [row | {"value": 1e-6, "sigma": 1e-8}, row | {"sensor": "accel"}]
    limit = {"kind": "bias", "limit": 1e-5, "unit": "rad/s", "decision_rule": GUARD_BAND}
    limits = [limit | {"sensor": "gyro"}]
    (usable,) = conformity_rows(result, limits, (), {})
    (unusable,) = conformity_rows(result, limits, {("gyro", "")}, {})
    assert usable["statement"] == CONFORMS
    assert unusable["statement"] == "not_assessed" and unusable["risk"] is None


def test_a_bias_that_jumped_is_judged_by_what_it_is_since_then():
    """0.3 °/h before and 3.3 after, of a tolerance of 2; their errors add to 0.05 °/h."""
    hour = np.radians(1 / 3600)
    own = {"mount": "", "sensor": "gyro", "unit": "rad/s"}
    bias = {"id": "b", "parameter": "bias_x", "effect": None, "value": 0.3 * hour}
    jump = {"id": "j", "parameter": "gyro_bias_jump.b_x", "effect": "gyro_bias_jump"}
    result = [
        own | bias | {"sigma": 0.04 * hour},
        own | jump | {"value": 3.0 * hour, "sigma": 0.05 * hour},
    ]
    limit = {"sensor": "gyro", "kind": "bias", "limit": 2 * hour, "unit": "rad/s"}
    limits = [limit | {"decision_rule": GUARD_BAND}]
    common = {("b", "j"): -0.0008 * hour**2}
    (after,) = conformity_rows(result, limits, (), common)
    assert after["statement"] == DOES_NOT_CONFORM and after["risk"] < 1e-9
    (before,) = conformity_rows(result[:1], limits, (), common)
    assert before["statement"] == CONFORMS
    result[1]["value"] = 1.65 * hour  # 1.95 ± 0.05: within, and not by two sigma
    (near,) = conformity_rows(result, limits, (), common)
    assert near["statement"] == NOT_SHOWN


# ---- In the report


def test_the_certificate_says_what_is_not_stated():
    shown = section_on(campaign(logs=()), SECTION)
    assert "<dt>Customer</dt><dd>A customer</dd>" in shown
    assert "<dt>Not stated</dt><dd>Laboratory" in shown
    assert "Not assessed: no tolerances are stated." in shown
    # Without a laboratory it is none: nobody signs.
    assert "Calibrated by" not in shown
    assert "End of the certificate." not in shown


def test_a_value_stands_with_twice_its_sigma():
    """S0's x gyro: 615.1 ppm, in the synthetic campaign ± 2.2 ppm."""
    made = campaign(logs=())
    own = (made["result"]["sensor"] == "gyro") & (made["result"]["parameter"] == "scale_x")
    made["result"].loc[own, ["value", "sigma"]] = 6.151e-4, 2.2e-6
    row = re.search(r"<i>s</i><sub>x</sub>.*", section_on(made, SECTION)).group()
    cells = [re.sub("<[^>]*>", "", cell).rstrip("\u2007\u2008") for cell in row.split("</td>")]
    assert cells[5:8] == ["615.1", "±\u202f4.4", "ppm"]


def test_what_is_not_corrected_stands_in_units_of_u():
    """A shift of 0.52 σ is one of 0.26 U; a cause that is removed shifts nothing."""
    made = campaign(logs=())
    causes = made["causes"]
    causes["moves"] = np.where(causes["cure"] == "none", 0.52, 4.0)
    shown = section_on(made, SECTION)
    assert shown.count("Not corrected, and no component of U") == (causes["cure"] == "none").sum()
    assert "oscillation, which shifts no parameter by more than 0.26 U." in shown
    causes["moves"] = 0.05
    assert "Not corrected" not in section_on(made, SECTION)


def test_undetected_effects_that_may_shift_a_parameter_by_more_than_u_are_counted():
    """U is 2 σ: a shift of 1.9 σ is in it, one of 2.1 σ is not."""
    made = campaign(logs=())
    limits = made["detection_limits"]
    visible = (limits["reason"] == "visible") & limits["limit"].notna()
    limits["moves"] = np.where(visible, 1.9, np.nan)
    assert "No component of U" not in section_on(made, SECTION)
    one = limits["effect"] == limits.loc[visible, "effect"].iloc[-1]
    limits.loc[visible & one, "moves"] = 2.1
    assert "effects that were not detected. One of " in section_on(made, SECTION)


@pytest.mark.parametrize(
    ("risk", "text"), [(1e-13, "< 0.01 %"), (9e-5, "< 0.01 %"), (0.0228, "2.3 %")]
)
def test_a_risk_is_no_smaller_than_tails_are_known(risk, text):
    assert _risk(risk) == text


def test_the_certificate_has_what_its_values_mean_and_rest_on():
    shown = re.sub("<[^>]*>", " ", section_on(campaign(logs=()), SECTION))
    assert "reading = (I + S + N) · truth + b" in shown
    assert "Latitude" in shown
