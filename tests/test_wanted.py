"""The time that the rests must last for a wanted sigma is the time that gives it."""

import chain
import numpy as np
import pytest

BIAS = ["bias_x", "bias_y", "bias_z"]


def wanted(results: chain.Results, stage: str):
    return results[f"{stage}/wanted"].set_index("quantity")


@pytest.fixture(scope="module")
def of_20_and_60_s() -> tuple[chain.Results, chain.Results]:
    return chain.in_memory_of(lasting(20)), chain.in_memory_of(lasting(60))


@pytest.mark.parametrize(
    ("stage", "method"), [("accelerometer", "six_position"), ("gyroscope", "static")]
)
def test_rests_of_that_length_have_that_sigma(stage, method, of_20_and_60_s):
    short, long = of_20_and_60_s
    told, then = wanted(short, stage), wanted(long, stage)
    assert list(told.index) == BIAS and set(told["method"]) == {method}
    # From what rests of 20 s give, the sigma of rests of 60 s is foretold, and the time for it.
    told, then = told.loc[BIAS], then.loc[BIAS]
    noise = told["random_walk"] ** 2 / then["seconds"]
    # The level of the noise is known to some per cent.
    np.testing.assert_allclose(np.sqrt(noise + told["floor"] ** 2), then["sigma"], rtol=0.06)
    room = told["wanted"] ** 2 - told["floor"] ** 2
    reachable = room > 0
    time = told["random_walk"] ** 2 / room
    np.testing.assert_allclose(told["wanted_seconds"][reachable], time[reachable])
    assert told["wanted_seconds"][~reachable].isna().all()
    assert reachable.any()


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
