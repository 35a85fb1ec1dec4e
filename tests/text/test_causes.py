"""The names of causes as a person would say them."""

from __future__ import annotations

import pytest

from inertial.effects import CATALOGUE
from inertial.text.cause_names import in_words
from inertial.text.parameters import sign_of
from inertial.text.units import quantity


@pytest.mark.parametrize(
    ("cause", "words"),
    [
        ("incomplete_turn", "incomplete turn"),
        ("gyro_g_sensitivity", "gyro g-sensitivity"),
        ("time_backwards", "time goes backwards"),
        ("heard_of\x1bnever", "heard of�never"),
    ],
)
def test_names_of_causes(cause: str, words: str) -> None:
    assert in_words(cause) == words


def test_every_unit_of_an_effect_has_one_of_the_laboratory():
    units = {parameter.unit for effect in CATALOGUE.values() for parameter in effect.parameters}
    written = {unit: quantity("", unit).laboratory.name for unit in units - {"Hz", "1", "s"}}
    assert not {unit for unit, name in written.items() if unit == name}
    assert written["1/s"] == "ppm/h"


def test_no_letter_of_a_parameter_is_spelled_out_where_it_is_read():
    """Words (north, frequency) stay; Greek letters and differences are signs."""
    words = {"north", "east", "lean", "quarter", "limit", "frequency", "amplitude", "upright"}
    names = {p.name.partition("_")[0] for effect in CATALOGUE.values() for p in effect.parameters}
    assert {sign_of(name) for name in names if len(name) > 2} - words == set("θφτδζ") | {"Δφ", "Δψ"}
    assert [sign_of(name) for name in ("theta_z", "g_xy", "dg")] == ["θ_z", "g_xy", "Δg"]
