"""Faulty data inside a good campaign do not move its result, or are named."""

from dataclasses import replace
from math import radians, tan
from typing import Any

import chain
import numpy as np
import pytest

import laboratory
from inertial.estimation.triad import linear_names

pytestmark = pytest.mark.slow

RATE = 200  # Hz
REST, STILL = 120, 6.5  # s
PER_SAMPLE = (0.02, 1e-3 * 9.80665)  # °/s and m/s²
MARKS = {"x": "+y", "y": "+z", "z": "+x"}
OFF = 0.1  # °, by what one position is off


def good(**changes: Any) -> dict[str, Any]:
    """Six rests of 120 s, 3 × 720° at 20 °/s there and back; the azimuth known."""
    document = chain.demo(**changes)
    document["receiver"] = {**document["receiver"], "rate_hz": RATE}
    root_hour = 60 / RATE**0.5
    document["noise"] = {
        **document["noise"],
        "angle_random_walk_deg_sqrt_h": PER_SAMPLE[0] * root_hour,
        "velocity_random_walk_m_s_sqrt_h": PER_SAMPLE[1] * root_hour,
    }
    document["handling"] = {"still_s": STILL}
    plan = [
        {"id": f"{axis}-{way}", "do": "rest", "up": sign + axis, "seconds": REST}
        for axis in "xyz"
        for way, sign in (("up", "+"), ("down", "-"))
    ] + [
        {"id": f"{axis}-{way}", "do": "turn", "up": f"+{axis}", "degrees": degrees}
        | {"rate_deg_s": 20, "accel_deg_s2": 20}
        for axis in "xyz"
        for way, degrees in (("forward", 720), ("backward", -720))
    ]
    for one in plan:
        one |= {"log": f"{one['id']}.asc", "mark": MARKS[one["up"][1]]}
    campaign = document["campaign"]
    campaign["plan"] = plan
    campaign["instrument"] = {
        "name": "of 200 Hz",
        "rate_hz": RATE,
        "axes": ["z", "-y", "x"],
        "format": {"kind": "rawimus"},
        "gyro": {"count_rad": document["receiver"]["gyro_count_rad"]},
        "accelerometer": {"count_m_s": document["receiver"]["accelerometer_count_m_s"]},
    }
    campaign["table"] = {**campaign["table"], "heading_deg": 20}
    return document


def lost() -> dict[str, Any]:
    line = round((STILL + 15) * RATE)
    return {"faults": [{"lose": {"log": "x-forward.asc", "line": line, "samples": RATE // 5}}]}


def spiked() -> dict[str, Any]:
    random = np.random.default_rng(3)
    return {
        "faults": [
            {
                "spikes": {
                    "log": f"{axis}-{way}.asc",
                    "channel": f"accel_{channel}",
                    "lines": (1 + random.choice(REST * RATE, 50, replace=False)).tolist(),
                    "size_m_s2": 50,
                }
            }
            for axis in "xyz"
            for way in ("up", "down")
            for channel in "xyz"
        ]
    }


def fast() -> dict[str, Any]:
    return {"effects": {"table_speed_error": {"rate_ppm": 100}}}


def values(results: chain.Results) -> np.ndarray:
    """The 24 parameters, accelerometers first."""
    stages = ("accelerometer", "gyroscope")
    return np.array([results.parameters(s)["value"].reindex(linear_names()) for s in stages])


@pytest.fixture(scope="module")
def clean() -> chain.Results:
    return chain.in_memory_of(good(), "criticism", chain.BESIDE)


@pytest.mark.parametrize("spoilt", [lost, spiked, fast])
def test_the_result_stays_where_it_is(spoilt, clean):
    moved = np.abs(values(chain.in_memory_of(good(**spoilt()))) - values(clean))
    assert moved[1, :9].max() < 25e-6
    assert moved[0, 9:].max() < 5e-6 * 9.80665


def test_the_earth_rate_does_not_leak_into_the_g_sensitivity(clean):
    told = clean["criticism/effects"].set_index("effect").loc["gyro_g_sensitivity"]
    degrees_per_hour = np.degrees(told["value"].dropna()) * 3600 * 9.80665
    assert len(degrees_per_hour) == 9
    assert degrees_per_hour.abs().max() < 1


@pytest.mark.slow
def test_a_position_that_is_off_is_noticed_and_what_it_spoils_is_named():
    told = good()
    leaning = [0.0, 1.0, tan(radians(OFF))]  # y up, off towards z
    crooked = good()
    for one in crooked["campaign"]["plan"]:
        if one["id"] == "y-up":
            one["up"] = leaning
    true = laboratory.perform(laboratory.specify(crooked))
    # The laboratory believes and writes down what it had planned.
    believed = {**true.campaign, "plan": told["campaign"]["plan"]}
    recording = replace(true, campaign=believed)
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    # It is weighed against the effects, in one place, and named with what alone resembles it: had
    # the case turned after y-up, all the rest would have cross-axis terms in common again; or the
    # accelerometers are disturbed there and nowhere else.
    assert results["accelerometer/findings"].empty
    (cause,) = results["criticism/findings"].to_dict("records")
    assert cause["cause"] == "table_position_error"
    members = results["criticism/members"].set_index("effect")["probability"]
    assert set(members.index[1:]) == {"mounting_shift", "accel_bias_of_position"}
    assert members.index[0] == "table_position_error" and members.iloc[0] > 0.9
    positions = results["criticism/cause_positions"].set_index("finding")
    assert positions.loc[[cause["id"]]].iloc[0]["position"] == "y-up"
    assert "at y-up" in cause["sentence"] and "z-up" not in cause["sentence"]
    # Free to lean there, the case gives the parameters back; what it has not seen is foretold.
    moved = results["extension/moved"].set_index("joint_id")
    cross = moved.loc["accelerometer/joint/cross_zy"]
    # Of eight equal means an eighth; the turns there tell the tilt of the axis, which takes some.
    assert np.radians(OFF) / 16 < abs(cross["difference"]) < np.radians(OFF) / 7
    assert cross["extended_sigma"] < cross["joint_sigma"] / 4
    verdict = results["diagnosis/verdict"].set_index("sensor")
    # The gyros' result is the mean with and without the shift, by how probable that is.
    assert dict(verdict["method"]) == {"gyro": "mixture", "accel": "extended"}
