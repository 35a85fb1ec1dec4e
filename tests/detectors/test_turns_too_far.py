"""Turns that go farther than their plan states, by the plan's mistake or the table's."""

from math import degrees

import chain
import numpy as np
import pytest


@pytest.mark.parametrize("name", ["x-forward", "z-backward"])
def test_a_turn_that_goes_too_far_lacks_nothing(name):
    document = chain.short()
    (turn,) = (one for one in document["campaign"]["plan"] if one["id"] == name)
    planned = turn["degrees"]
    turn["degrees"] = 1.25 * planned
    document["misstated"] = {"plan": {name: {"degrees": planned}}}
    results = chain.in_memory_of(document, "segment")
    (finding,) = results["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["manoeuvre"]) == ("wrong_angle", name)
    turned = results["segment/performed"].set_index("manoeuvre")["angle"].map(degrees)
    beyond = abs(turned[name] - planned)
    assert beyond == pytest.approx(90, abs=0.3)
    assert finding["sentence"].endswith(f"it is {beyond:.2f}° too far.")
    assert "missing" not in finding["sentence"] and "rounded" not in finding["consequence"]
    told = f"state degrees: {1.25 * planned:.0f} for {name}".replace("-4", "−4")
    assert told in finding["action"] and "record" in finding["action"]


@pytest.mark.parametrize("done", [180, 117])
def test_turns_that_go_too_far_by_one_factor_are_one_finding(done):
    """Two of 90° in the plan were "incomplete", 90° too far, to be recorded again."""
    document = chain.short()
    planned = {"z-forward": {"degrees": 90}, "z-backward": {"degrees": -90}}
    for one in document["campaign"]["plan"]:
        if one["id"] in planned:
            one["degrees"] = done * np.sign(planned[one["id"]]["degrees"])
    document["misstated"] = {"plan": planned}
    results = chain.in_memory_of(document, "segment")
    (finding,) = results["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["count"]) == ("wrong_angle", 2)
    assert f"2 turns go {done / 90:.3g}" in finding["sentence"].replace("1.30", "1.3")
    assert "record" in finding["action"]
    both = "state degrees: 180 for z-forward and −180 for z-backward in the plan"
    assert (both in finding["action"]) == (done == 180)
