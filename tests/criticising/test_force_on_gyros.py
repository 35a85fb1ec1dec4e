"""Gyros that feel specific force, off the axis of the table: a turn pulls at them, too."""

import chain
import numpy as np
import pytest

G = np.array([[0, 30, 0], [-40, 0, 20], [10, -30, 0]])  # °/h/g
ARM = [0.05, -0.03, 0.02]  # m


@pytest.mark.slow
def test_the_pull_of_a_turn_is_force_that_a_gyro_feels() -> None:
    """At 150 °/s it is 0.04 g, and changes a gyro in proportion to the square of the rate."""
    effects = {"lever_arm": {"arm_m": ARM}, "gyro_g_sensitivity": {"matrix_deg_h_g": G.tolist()}}
    document = chain.short(effects=effects, seed=3)
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn":
            one |= {"rate_deg_s": 150, "accel_deg_s2": 150}
            one["degrees"] *= 10
    results = chain.in_memory_of(document, "criticism")
    assert {*results["criticism/findings"]["cause"]} == {"lever_arm", "gyro_g_sensitivity"}
