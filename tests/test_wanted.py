"""The time that the rests must last for a wanted sigma is the time that gives it."""

import chain
import numpy as np
import pytest

BIAS = ["bias_x", "bias_y", "bias_z"]


def wanted(results: chain.Results, stage: str):
    return results[f"{stage}/wanted"].set_index("quantity")


@pytest.fixture(scope="module")
def of_20_s() -> chain.Results:
    return chain.in_memory_of(lasting(20))


@pytest.fixture(scope="module")
def of_60_s() -> chain.Results:
    return chain.in_memory_of(lasting(60))


@pytest.mark.parametrize(
    ("stage", "method"), [("accelerometer", "six_position"), ("gyroscope", "static")]
)
def test_rests_of_60_s_have_the_sigma_that_rests_of_20_s_foretell(stage, method, of_20_s, of_60_s):
    told, then = wanted(of_20_s, stage), wanted(of_60_s, stage)
    assert list(told.index) == BIAS and set(told["method"]) == {method}
    noise = told["random_walk"] ** 2 / 60
    # The level of the noise is known to some per cent.
    np.testing.assert_allclose(np.sqrt(noise + told["floor"] ** 2), then["sigma"], rtol=0.06)


def test_rests_of_the_time_that_is_told_have_the_sigma_that_is_wanted(of_20_s):
    told = wanted(of_20_s, "gyroscope").loc["bias_x"]
    assert told["sigma"] > 1.1 * told["wanted"]
    long_enough = chain.in_memory_of(lasting(float(told["wanted_seconds"])))
    then = wanted(long_enough, "gyroscope").loc["bias_x"]
    assert then["sigma"] == pytest.approx(told["wanted"], rel=0.06)


def lasting(seconds: float):
    document = chain.short()
    for m in document["campaign"]["plan"]:
        if m["do"] == "rest":
            m["seconds"] = seconds
    return document


def test_no_time_averages_out_a_tilt():
    document = chain.short()
    document["campaign"]["table"]["position_sigma_arcsec"] = 30
    results = chain.in_memory_of(document, "accelerometer")
    told = wanted(results, "accelerometer")
    # Four of six readings of an axis are level: σ g/√6 · √(4/6) = σ g/3.
    floor = np.radians(30 / 3600) * 9.794 / 3
    np.testing.assert_allclose(told["floor"], floor, rtol=1e-3)
    assert told["wanted_seconds"].isna().all()
