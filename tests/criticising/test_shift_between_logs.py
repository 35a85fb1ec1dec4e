"""An IMU that is mounted anew between two logs that share no clock, with the same bias."""

import shutil
from itertools import product
from typing import Any

import chain
import numpy as np
import pytest

TWO_HOURS = 7200.0  # s, after which stamps that go on need be of no common clock
SHIFT = [300.0, -200.0, 250.0]  # arc seconds, about x, y and z


def rests_and_turns(**effects: Any) -> dict[str, Any]:
    """Six rests in one log, which ends after 150 s, and six turns in another."""
    document = chain.short(effects=effects, seed=4)
    document["handling"] |= {"still_s": 8, "change_s": 6}
    document["start"]["pause_s"] = TWO_HOURS
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    for one in document["campaign"]["plan"]:
        one["log"] = f"{one['do']}s.csv"
        if one["do"] == "turn":
            one |= {"rate_deg_s": 20, "accel_deg_s2": 20}
    return document


@pytest.mark.slow
def test_it_is_named_with_its_angles_and_the_manoeuvre_from_which_on_it_is() -> None:
    """What gyros tell holds for the second mounting alone: a g-sensitivity was named in it."""
    shift = {"rotation_arcsec": SHIFT, "at_s": 170.0}
    document = rests_and_turns(mounting_shift=shift)
    results = chain.in_memory_of(document, "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "mounting_shift" and " at x-forward:" in cause["sentence"]
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["mounting_shift"]
    for axis, size in zip("xyz", np.radians(np.array(SHIFT) / 3600), strict=True):
        own = found.loc[f"theta_{axis}"]
        assert abs(own["value"] - size) < 3.5 * own["sigma"]
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    # Its turns are all in the second mounting: the accelerometers tell those of the first.
    assert verdicts["gyro"] == "usable_within_limits"
    own = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    matrix = np.array(document["truth"]["gyro"]["matrix"]) - np.eye(3)
    pulls = [
        (own.at[name, "value"] - matrix[i, k]) / own.at[name, "sigma"]
        for (i, a), (k, b) in product(enumerate("xyz"), repeat=2)
        for name in [f"scale_{a}" if a == b else f"cross_{a}{b}"]
    ]
    assert np.abs(pulls).max() < 3.5


@pytest.mark.slow
def test_a_bias_that_jumps_between_the_logs_is_three_numbers_and_no_bias_of_each_run() -> None:
    """All of it was "bias after each switch-on", of unknown size, or a g-sensitivity."""
    jump = {"size_micro_g": [300.0, -250.0, 200.0], "at_s": 170.0}
    document = rests_and_turns(accel_bias_jump=jump)
    for one in document["campaign"]["plan"][-2:]:
        one["log"] = "more.csv"
    results = chain.in_memory_of(document, "criticism")
    (finding,) = results["criticism/findings"].to_dict("records")
    assert finding["cause"] == "accel_bias_jump" and " at x-forward" in finding["sentence"]
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["accel_bias_jump"]
    for axis, size in zip("xyz", jump["size_micro_g"], strict=True):
        own = found.loc[f"b_{axis}"]
        assert abs(own["value"] - 9.80665e-6 * size) < 3.5 * own["sigma"]


@pytest.mark.slow
def test_a_log_of_another_imu_is_one_cause(tmp_path) -> None:
    """Its turns by an IMU whose axes and biases are others: five causes that all were wrong."""
    document, other = rests_and_turns(), rests_and_turns()
    random = np.random.default_rng(8)
    for sensor, unit, size in (("accelerometer", "m_s2", 3e-3), ("gyro", "rad_s", 2e-5)):
        own = other["truth"][sensor]
        own["matrix"] = (np.array(own["matrix"]) + 1e-3 * random.normal(size=(3, 3))).tolist()
        key = f"bias_{unit}"
        own[key] = (np.array(own[key]) + size * random.normal(size=3)).tolist()
    chain.simulate(document, tmp_path / "campaign")
    chain.simulate(other, tmp_path / "other")
    shutil.copy(tmp_path / "other" / "turns.csv", tmp_path / "campaign" / "turns.csv")
    results = chain.run(tmp_path / "campaign", tmp_path / "derived", "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "another_imu" and cause["sentence"].startswith("From x-forward to")
    assert set(results["diagnosis/verdict"]["verdict"]) == {"not_usable"}
