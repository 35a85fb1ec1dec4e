"""What the report says of the effects in a result: their equations, and the compensation."""

from __future__ import annotations

import re
from html import unescape

import pandas as pd
import pytest

from stages.report.sections import certificate, effect_terms
from stages.report.sections.parameters import PARAMETERS
from tests.report import synthetic, synthetic_unmodelled


def said(html: str) -> str:
    return unescape(re.sub(r"<[^>]*>", "", html))


@pytest.mark.parametrize(
    ("parameter", "equation"),
    [
        ("accel_quadratic.k2_x", "x: + k2_x · f_x²"),
        ("accel_cubic.k3_z", "z: + k3_z · f_z³"),
        ("accel_scale_asymmetry.a_y", "y: + a_y · |f_y|"),
        ("accel_warm_up.b_z", "z: + b_z · exp(−t / τ)"),
        ("accel_temperature.bias_y_1", "y: + (b_y per K) · (T − T0)"),
        ("gyro_scale_temperature.k_x", "x: + k_x · (T − T0) · ω_x"),
    ],
)
def test_a_further_term_has_its_equation(parameter: str, equation: str) -> None:
    effect = parameter.partition(".")[0]
    rows = [{"parameter": parameter, "value": 1}]
    assert effect_terms.added_to_readings(effect, rows) == equation


@pytest.mark.parametrize(
    ("effect", "names", "equation"),
    [
        ("gyro_warm_up", [f"b_{i}" for i in "xyz"], "+ b_i · exp(−t / τ)"),
        ("gyro_g_sensitivity", [f"g_{i}{j}" for i in "xyz" for j in "xyz"], "+ Σ_j g_ij · f_j"),
    ],
)
def test_the_same_term_of_three_axes_is_one_equation(effect, names, equation) -> None:
    rows = [{"parameter": f"{effect}.{name}", "value": 1} for name in names]
    assert effect_terms.added_to_readings(effect, rows) == equation


def test_what_is_no_term_of_a_reading_has_no_equation() -> None:
    assert not effect_terms.added_to_readings(
        "table_tilt", [{"parameter": "table_tilt.x", "value": 1e-6}]
    )


def with_quadratic_term(made: dict[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    effect = made["result"].query("sensor == 'accel'").iloc[:1].assign(
        id="diagnosis/accelerometer/accel_quadratic.k2_x",
        parameter="accel_quadratic.k2_x",
        effect="accel_quadratic",
        value=2e-5,
        sigma=4e-7,
        unit="(m/s²)/(m/s²)²",
    )  # fmt: skip
    return made | {"result": pd.concat([made["result"], effect], ignore_index=True)}


def test_an_effect_of_a_class_is_said_to_be_one_of_several() -> None:
    one_of = "Accelerometer quadratic term: one of 2 effects that these data do not distinguish"
    of_class = with_quadratic_term(synthetic_unmodelled.of_a_class())
    assert one_of in said(synthetic.section_on(of_class, certificate.SECTION))
    alone = with_quadratic_term(synthetic.brief())
    assert "do not distinguish" not in said(synthetic.section_on(alone, certificate.SECTION))


def test_the_compensation_takes_further_terms_off_where_there_are_some() -> None:
    alone = said(synthetic.section_on(synthetic.brief(), PARAMETERS))
    assert "truth = M⁻¹ · (reading − bias)" in alone
    assert "further terms" not in alone
    both = said(synthetic.section_on(with_quadratic_term(synthetic.brief()), PARAMETERS))
    assert "truth = M⁻¹ · (reading − bias − further terms)" in both
    assert "ready for use, together with the further terms of section 1." in both
