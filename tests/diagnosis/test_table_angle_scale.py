"""A scale error of the table's angle: tumbles show it to the accelerometers, not to the gyros."""

import hidden_plans
import pytest
from campaigns import diagnosed
from judge import parameters_of

pytestmark = pytest.mark.slow

SCALE = 40e-6
AXES = "xyz"


@pytest.fixture(scope="module")
def tables():
    effects = {"table_angle_scale": {"scale_ppm": SCALE * 1e6}}
    return diagnosed(hidden_plans.rates(effects=effects))


def test_it_is_named_and_nothing_else(tables):
    (cause,) = tables["causes"].to_dict("records")
    assert (cause["cause"], cause["verdict"]) == ("table_angle_scale", "found")
    assert cause["size"] == pytest.approx(SCALE, abs=4 * cause["sigma"])


def test_the_scale_factors_of_the_gyros_are_rid_of_it(tables):
    """Turns that go 40 ppm too far make them 40 ppm too large, some 45 of their sigmas."""
    document = hidden_plans.rates()
    result = tables["result"].set_index(["sensor", "parameter"])
    for axis in AXES:
        own = result.loc["gyro", f"scale_{axis}"]
        true = parameters_of(document)["gyro"][f"scale_{axis}"]
        assert own["value"] == pytest.approx(true, abs=4 * own["sigma"])
        assert 0.3e-6 < own["sigma"] < SCALE / 10
    assert set(tables["verdict"]["verdict"]) == {"usable_within_limits"}
