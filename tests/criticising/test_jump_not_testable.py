"""A jump of the gyros' bias between two logs, in which the accelerometers may have jumped too."""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

from inertial.estimation.effect_information import EffectInformation
from stages.criticism.confounded_causes import jumps_not_testable

JUMP = {"size_deg_h": [40.0, -30.0, 50.0], "at_s": 210.0}


def judged(log_of: Mapping[str, str], backward: str) -> tuple[pd.DataFrame, list[str]]:
    """The verdicts by sensor and the names of the causes, with the log of each manoeuvre.

    `backward`: the sign of the axis that is up where it turns backward.
    """
    document = chain.short(effects={"gyro_bias_jump": JUMP}, seed=4)
    document["handling"] |= {"still_s": 8, "change_s": 6}
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    plan = {one["id"]: one for one in document["campaign"]["plan"]}
    for one in plan.values():
        one["log"] = log_of[one["id"]]
        if one["do"] == "turn":
            one |= {"rate_deg_s": 20, "accel_deg_s2": 20}
        if one["id"].endswith("backward"):
            one["up"] = backward + one["up"][-1]
    document["campaign"]["plan"] = [plan[name] for name in log_of]
    results: Mapping[str, Any] = chain.in_memory_of(document, "diagnosis")
    verdicts = results["diagnosis/verdict"].set_index("sensor")
    return verdicts, list(results["diagnosis/causes"]["cause"])


@pytest.mark.slow
def test_accelerometers_whose_axes_are_all_up_before_it_hold_on_condition() -> None:
    """They were "usable, no fault", and a jump that this plan hides moved them by 131 sigma."""
    up = [f"{axis}-{what}" for axis in "xyz" for what in ("up", "forward")]
    down = [f"{axis}-{what}" for axis in "xyz" for what in ("down", "backward")]
    log_of = dict.fromkeys(up, "up.csv") | dict.fromkeys(down, "down.csv")
    verdicts, causes = judged(log_of, "-")
    assert causes == ["gyro_bias_jump", "jump_not_testable"]
    assert verdicts["verdict"]["accel"] == "on_condition"
    assert "did not change" in verdicts["condition"]["accel"]
    assert "Set right" not in verdicts["sentence"]["accel"]


@pytest.mark.slow
def test_where_both_logs_hold_an_axis_up_and_down_it_is_known_that_they_did_not() -> None:
    first = ["x-up", "x-down", "y-up", "y-down", "z-up", "x-forward", "y-forward", "z-forward"]
    last = ["z-down", "x-backward", "y-backward", "z-backward"]
    verdicts, causes = judged(dict.fromkeys(first, "one.csv") | dict.fromkeys(last, "two.csv"), "+")
    assert "jump_not_testable" not in causes and verdicts["verdict"]["accel"] == "usable"


@pytest.mark.parametrize(("informative", "found"), [(7.0, []), (0.0, ["gyro"])])
def test_it_is_asked_of_the_others_jump_at_the_same_time(informative, found) -> None:
    """A scan that was refined about its maximum has more times than that of the other sensor."""
    times = {"accel_bias_jump": [10.0, 20.0, 25.0, 30.0], "gyro_bias_jump": [10.0, 20.0, 30.0]}
    columns = [f"{name} {at}" for name, own in times.items() for at in own]
    information = np.ones(len(columns))
    information[-1] = informative  # of the gyros' jump at 30 s
    selection = SimpleNamespace(
        named=SimpleNamespace(
            causes=[SimpleNamespace(effect="accel_bias_jump", value=3, verdict="found")]
        ),
        families={name: [SimpleNamespace(at=at) for at in own] for name, own in times.items()},
        effect=lambda name, value: SimpleNamespace(at=times[name][value]),
        searched=[
            SimpleNamespace(name="accel_bias_jump", candidates=((0,), (1,), (2,), (3,))),
            SimpleNamespace(name="gyro_bias_jump", candidates=((4,), (5,), (6,))),
        ],
        evidence=SimpleNamespace(
            labels=("gyro", "accel"),
            total=EffectInformation(
                tuple(columns), np.diag(information), np.zeros(len(columns)), 0.0, 9
            ),
        ),
    )
    assert [row["sensor"] for _table, row in jumps_not_testable(selection, "")] == found
