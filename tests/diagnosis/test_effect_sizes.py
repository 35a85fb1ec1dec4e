"""The card of an effect in the model states its size by the result, as the certificate does."""

import re
from math import pi

import chain
import pytest

pytestmark = pytest.mark.slow

DEG_H_PER_G = pi / 180 / 3600 / 9.80665  # rad/s per m/s²
NUMBER = re.compile(r"(g_[xyz]{2}) = (−?[\d.]+) ± ([\d.]+) °/h/g")


@pytest.fixture(scope="module")
def diagnosed(demo_criticised):
    """The demo's tables of diagnosis, and those that it reads."""
    return demo_criticised, chain.again(demo_criticised, "diagnosis")


def of_g_sensitivity(table):
    return table[table["cause"] == "gyro_g_sensitivity"].iloc[0]


def numbers_in(sentence):
    """By parameter the value and the sigma in a sentence, °/h/g, and one unit of its last digit."""
    return {
        name: (float(value.replace("−", "-")), float(sigma), 10.0 ** -len(sigma.split(".")[1]))
        for name, value, sigma in NUMBER.findall(sentence)
    }


def test_sentence_and_size_are_those_of_the_result(diagnosed):
    results, tables = diagnosed
    rows = tables["result"].set_index("parameter")
    cause = of_g_sensitivity(tables["causes"])
    stated = numbers_in(cause["sentence"])
    assert set(stated) == {"g_xx", "g_yy", "g_zz"}  # what the demo hides
    for name, (value, sigma, digit) in stated.items():
        row = rows.loc[f"gyro_g_sensitivity.{name}"]
        assert value == pytest.approx(row["value"] / DEG_H_PER_G, abs=0.51 * digit)
        assert sigma == pytest.approx(row["sigma"] / DEG_H_PER_G, abs=0.51 * digit)
    assert cause["size"] == rows.loc["gyro_g_sensitivity.g_xx", "value"]
    by_criticism = numbers_in(of_g_sensitivity(results["criticism/findings"])["sentence"])
    assert by_criticism["g_yy"] != stated["g_yy"]  # so that this test can fail


def test_an_effect_that_the_result_does_not_have_keeps_its_sentence(demo_criticised):
    joint = demo_criticised["extension/candidates"]
    tables = chain.again(demo_criticised, "diagnosis", candidates=joint[joint["method"] == "joint"])
    sentence = of_g_sensitivity(tables["causes"])["sentence"]
    assert sentence == of_g_sensitivity(demo_criticised["criticism/findings"])["sentence"]
