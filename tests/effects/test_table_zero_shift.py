"""24 positions on a table whose middle axis counts from another zero from the middle of them on."""

from typing import Any

import chain
import hidden_plans
import numpy as np
import pytest

from inertial.text.units import ARC_SECOND

ROUND = {"x": "yz", "y": "zx", "z": "xy"}  # the level axes, in the sense of a turn about each


def document(seed: int, **effects: Any) -> dict[str, Any]:
    """Each face up at four azimuths; then a turn there and back about each axis, upwards."""
    made = hidden_plans.stops(seed=seed, effects=effects)
    made["handling"] = {"still_s": 4, "change_s": 6}
    plan: list[dict[str, Any]] = []
    for up, mark in hidden_plans.MARKS.items():
        marks = [sign + axis for sign in "+-" for axis in ROUND[up[1]]]
        first = marks.index(mark)
        plan += [
            {"id": f"{up[1]}-{'up' if up[0] == '+' else 'down'}-{i}", "do": "rest", "up": up}
            | {"mark": towards, "seconds": 60}
            for i, towards in enumerate(marks[first:] + marks[:first])
        ]
    turn = {"do": "turn", "rate_deg_s": 20, "accel_deg_s2": 20}
    plan += [
        turn
        | {"id": f"{axis}-{way}", "up": f"+{axis}", "mark": hidden_plans.MARKS[f"+{axis}"]}
        | {"degrees": degrees, "position": f"{axis}-turned"}
        for axis in "xyz"
        for way, degrees in (("forward", 360), ("backward", -360))
    ]
    made["campaign"] |= {"plan": plan, "log": "all.asc"}
    return made


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "shift", "at", "upright"),
    [(1, 180.0, 850.0, None), (4, -120.0, 1200.0, "-x"), (9, 60.0, 600.0, "+x")],
)
def test_it_is_named_and_both_sensors_are_rid_of_it(seed, shift, at, upright):
    """All turns come after it: gyros took it for cross terms, 89 sigma off, and were usable.

    In the last one all rests with z up and down do, so that both sensors have these terms.
    """
    hidden = {"shift_arcsec": shift, "at_s": at} | ({"upright": upright} if upright else {})
    made = document(seed, table_zero_shift=hidden)
    results = chain.in_memory_of(made, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == ("table_zero_shift_outer" if upright else "table_zero_shift")
    assert abs(abs(cause["size"]) - abs(shift) * ARC_SECOND) < abs(shift) * ARC_SECOND / 8
    parameters = results["diagnosis/result"].set_index(["sensor", "parameter"])
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    for sensor, key in (("gyro", "gyro"), ("accel", "accelerometer")):
        if verdicts[sensor] == "not_usable":
            continue
        true = np.array(made["truth"][key]["matrix"])
        for i, row in enumerate("xyz"):
            for j, column in enumerate("xyz"):
                if i != j:
                    own = parameters.loc[(sensor, f"cross_{row}{column}")]
                    assert abs(own["value"] - true[i, j]) < 4.5 * own["sigma"]


@pytest.mark.slow
def test_nothing_is_named_where_its_zero_stays():
    results = chain.in_memory_of(document(2), "diagnosis", chain.BESIDE)
    assert results["diagnosis/causes"].empty
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable"}
