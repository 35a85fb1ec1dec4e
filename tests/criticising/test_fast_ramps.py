"""A table that starts within a block or two: each mean has the angular acceleration of its own."""

import chain
import numpy as np
import pytest

ARM = {"r_x": 0.12, "r_y": -0.05, "r_z": 0.2}  # m


@pytest.mark.slow
@pytest.mark.parametrize("acceleration", [80, 10])
def test_a_long_lever_arm_is_the_only_cause_with_its_size(acceleration: float) -> None:
    document = chain.short(effects={"lever_arm": {"arm_m": list(ARM.values())}}, seed=3)
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn":
            one |= {"rate_deg_s": 50, "accel_deg_s2": acceleration}
            one["degrees"] *= 4
    results = chain.in_memory_of(document, "criticism")
    assert list(results["criticism/findings"]["cause"]) == ["lever_arm"]
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["lever_arm"]
    for name, size in ARM.items():
        assert abs(found.loc[name, "value"] - size) < 3.5 * found.loc[name, "sigma"]
    # A ramp that is told by its corners alone is right to a part of a block.
    assert np.all(found["sigma"] < 1e-4)
