"""A staircase of rates without marks: turns that are not whole, there and back, in one position.

The table goes back before each turn, through the same angle in another time: that motion was taken
for the turn, which then began elsewhere than it did, and the gyros had a structure without a name.
"""

from typing import Any

import chain
import hidden_plans
import numpy as np
import pytest
from judge import parameters_of

pytestmark = pytest.mark.slow


def stairs(seed: int) -> dict[str, Any]:
    """Six faces; on the three upper ones turns of 17.3 s each way at four rates, gyros of a FOG."""
    document = hidden_plans.rates(seed=seed)
    del document["temperature"]
    plan: list[dict[str, Any]] = []
    for axis in "xyz":
        for sign in "+-":
            at = {"up": sign + axis, "position": f"{axis}{sign}"}
            plan.append(at | {"id": f"{axis}{sign}", "do": "rest", "seconds": 60})
            if sign == "-":
                continue
            for rate in (5, 10, 20, 40):
                turn = at | {"do": "turn", "rate_deg_s": rate, "accel_deg_s2": 40}
                plan.append(turn | {"id": f"{axis}-{rate}-there", "degrees": 17.3 * rate})
                plan.append(turn | {"id": f"{axis}-{rate}-back", "degrees": -17.3 * rate})
    document["campaign"]["plan"] = plan
    document["campaign"]["table"].pop("heading_deg", None)
    document["noise"] |= {"angle_random_walk_deg_sqrt_h": 0.003}
    document["truth"] = hidden_plans.sensors(np.random.default_rng(seed))
    return document


@pytest.mark.parametrize("seed", [1, 2])
def test_a_clean_one_has_no_cause_and_its_biases_are_right(seed):
    document = stairs(seed)
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    assert results["diagnosis/causes"].empty
    result = results["diagnosis/result"].set_index(["sensor", "parameter"])
    true = parameters_of(document)["gyro"]
    for axis in "xyz":
        own = result.loc["gyro", f"bias_{axis}"]
        assert abs(own["value"] - true[f"bias_{axis}"]) < 4 * own["sigma"]


def test_stamps_that_the_table_contradicts_are_wrong_and_the_rate_of_samples_is_right():
    """Two clocks, of the samples and of the table, agree against the third."""
    document = stairs(3)
    log = document["campaign"]["log"]
    document["campaign"]["table"]["rate_sigma_ppm"] = 20
    document["faults"] = [{"drift": {"log": log, "ppm": 300}}]
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert (cause["cause"], cause["sensor"]) == ("clock_scale", "gyro")
    assert cause["size"] == pytest.approx(300, rel=0.01)
    assert cause["sentence"].endswith("at the stated rate, and the stamps are wrong.")
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts.to_dict() == {"gyro": "not_usable", "accel": "usable"}


def test_beside_a_rate_of_samples_that_is_misstated_an_asymmetry_has_its_name():
    """The clock took it for its consequence, though it is off by the same in all that is read."""
    asymmetry = {"gyro_scale_asymmetry": {"asymmetry_ppm": [0, 500, 0]}}
    document = hidden_plans.rates(seed=5, effects=asymmetry)
    document["faults"] = [{"drift": {"log": document["campaign"]["log"], "ppm": 3000}}]
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    causes = results["diagnosis/causes"].set_index("cause")
    assert set(causes.index) == {"clock_scale", "gyro_scale_asymmetry"}
    found = causes.loc["gyro_scale_asymmetry"]
    assert found["axis"] == "y" and abs(found["size"] - 500e-6) < 4 * found["sigma"]
