"""Scale factors that are others on another day, in a campaign whose plan is performed twice."""

from copy import deepcopy
from typing import Any

import chain
import numpy as np
import pytest

DAY = 86_400.0  # s
SECOND_DAY = 300.0  # s since the first sample: in the pause between the two days
TRIADS = {"gyro": "gyro", "accel": "accelerometer"}
JUMPS = {"gyro": [400.0, -250.0, 300.0], "accel": [150.0, 120.0, -200.0]}  # ppm


def two_days(**effects: Any) -> dict[str, Any]:
    """The short plan, once a day, each day in a log of its own."""
    document = chain.short(effects=effects, seed=6)
    document["handling"]["change_s"] = 5
    document["start"]["pause_s"] = DAY
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    plan = []
    for day in (1, 2):
        for one in deepcopy(document["campaign"]["plan"]):
            plan.append(one | {"id": f"{one['id']}-{day}", "log": f"day-{day}.csv"})
    document["campaign"]["plan"] = plan
    return document


@pytest.mark.slow
@pytest.mark.parametrize("sensor", JUMPS)
def test_it_is_the_only_cause_with_its_sizes(sensor: str) -> None:
    """It was a g-dependence, or harmless differences between the logs."""
    jump = {"k_ppm": JUMPS[sensor], "at_s": SECOND_DAY}
    results = chain.in_memory_of(two_days(**{f"{sensor}_scale_jump": jump}), "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == f"{sensor}_scale_jump"
    place = {"gyro": "x-up-2, or later up to x-forward-2", "accel": "x-up-2"}[sensor]
    assert f"scale factor jump at {place}: " in cause["sentence"]
    sizes = results["criticism/effects"].set_index(["effect", "parameter"]).loc[cause["cause"]]
    for axis, ppm in zip("xyz", JUMPS[sensor], strict=True):
        own = sizes.loc[f"k_{axis}"]
        assert abs(own["value"] - 1e-6 * ppm) < 3.5 * own["sigma"] < 1e-6 * abs(ppm)
    # The scale factors of the result are those of the first day.
    truth = np.diag(two_days()["truth"][TRIADS[sensor]]["matrix"]) - 1
    result = results["diagnosis/result"].query("sensor == @sensor and effect.isna()")
    result = result.set_index("parameter").loc[[f"scale_{axis}" for axis in "xyz"]]
    assert (np.abs(result["value"] - truth) < 3.5 * result["sigma"]).all()


@pytest.mark.slow
def test_two_days_with_the_same_scale_factors_show_none() -> None:
    results = chain.in_memory_of(two_days(), "diagnosis")
    assert results["diagnosis/causes"].empty
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}
