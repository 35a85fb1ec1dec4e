"""An IMU that creeps in its fixture is named, and nothing that looks like it at times is."""

import re
from typing import Any

import chain
import numpy as np
import pytest
from hidden import hidden_plans

from inertial.text.units import ARC_SECOND

# A position is a rest of 30 s and four turns, each of 13 s between 8 s of rest; 10 s are between
# positions. From the middle of the first rest to that of the last:
FIRST_TO_LAST_S = 6 * (30 + 4 * (8 + 13 + 8)) + 5 * 10 - 15 - 4


def held_positions(effects: dict[str, Any]) -> dict[str, Any]:
    """Six faces, each held for a rest and two rounds there and back, in one log."""
    document = chain.short()
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["log"] = "session.csv"
    document["campaign"]["plan"] = [
        {"id": f"{up}-{k}", "position": up, "up": up} | done
        for up in (way + axis for axis in "xyz" for way in "+-")
        for k, done in enumerate(
            [
                {"do": "rest", "seconds": 30},
                *(
                    {"do": "turn", "degrees": d, "rate_deg_s": 30, "accel_deg_s2": 30}
                    for d in (360, -360, 360, -360)
                ),
            ]
        )
    ]
    document["handling"] |= {"change_s": 10, "still_s": 8}
    document["effects"] = effects
    return document


def creeps(effects: dict[str, Any]) -> list[dict[str, Any]]:
    results = chain.in_memory_of(held_positions(effects), "segment", chain.BESIDE)
    findings = results["segment/findings"]
    return findings[findings["cause"] == "fixture_creep"].to_dict("records")


def test_a_bias_that_jumps_in_one_rest_is_no_creep() -> None:
    """That position alone looked like one, by 92 arcsec, and no sensor was usable."""
    rest = {"log": "x-down.asc", "line": 18074, "samples": 5841, "channel": "accel_z"}
    document = hidden_plans.stops(effects={}, faults=[{"step": rest | {"size_m_s2": 0.002}}])
    found = chain.in_memory_of(document, "segment", chain.BESIDE)["segment/findings"]
    assert found["cause"].tolist() == ["bias_jump"]


@pytest.mark.slow
@pytest.mark.parametrize("tau", [400.0, 3000.0])
def test_a_creep_is_named_with_the_angle_by_which_the_case_turns(tau: float) -> None:
    """It was a bias that wanders at rest, and cross terms 20 sigma off were usable."""
    turns = -np.expm1(-FIRST_TO_LAST_S / tau)
    rotation = np.array([0.0, 60.0, 300.0]) / turns
    hidden = {"rotation_arcsec": rotation.tolist(), "time_constant_s": tau}
    (found,) = creeps({"mounting_creep": hidden})
    assert found["count"] == 6
    assert found["size"] / ARC_SECOND == pytest.approx(np.hypot(60, 300), rel=0.1)
    sentence = found["sentence"].replace("−", "-")
    told = [float(each) for each in re.findall(r"(-?[\d.]+) ±", sentence)]
    np.testing.assert_allclose(told, [0, 60, 300], atol=30)


@pytest.mark.slow
@pytest.mark.parametrize(
    "effects",
    [
        {},
        {"accel_warm_up": {"start_micro_g": [900, -600, 400], "time_constant_s": 300}},
        {"accel_bias_jump": {"size_micro_g": [500, -300, 200], "at_s": 310}},
        {"mounting_shift": {"rotation_arcsec": [0, 60, 300], "at_s": 160}},
    ],
    ids=["nothing", "warm-up", "jump", "shift"],
)
def test_what_is_no_creep_is_not_named_so(effects: dict[str, Any]) -> None:
    assert not creeps(effects)
