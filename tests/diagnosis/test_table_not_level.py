"""A table that leans by half a degree: its cosine is 34 ppm of g, the earth's rate leans, too."""

import hidden_plans
import pytest
from campaigns import diagnosed
from judge import parameters_of

pytestmark = pytest.mark.slow

LEAN = 1200.0  # arc seconds, towards north and towards west


@pytest.mark.parametrize("seed", [1, 2])
def test_it_is_the_only_cause_and_moves_no_parameter(seed):
    effects = {"table_tilt": {"north_arcsec": LEAN, "east_arcsec": -LEAN}}
    document = hidden_plans.stops(seed=seed, effects=effects)
    tables = diagnosed(document)
    assert tables["causes"]["cause"].tolist() == ["table_tilt"]
    assert set(tables["verdict"]["verdict"]) == {"usable_within_limits"}
    result = tables["result"].set_index(["sensor", "parameter"])
    for sensor, of_sensor in parameters_of(document).items():
        for parameter, true in of_sensor.items():
            own = result.loc[sensor, parameter]
            assert own["value"] == pytest.approx(true, abs=4 * own["sigma"]), parameter
    # Gravity, which all three scale factors have in common, is the most of their sigmas.
    scales = [
        result.loc["accel", f"scale_{axis}"]["value"]
        - parameters_of(document)["accel"][f"scale_{axis}"]
        for axis in "xyz"
    ]
    assert max(scales) - min(scales) < 5e-6
