"""An IMU that slips in its fixture while the table turns: the gyros see it, and what follows."""

import chain
import numpy as np
import pytest

ARC_SECOND = np.radians(1 / 3600)
# After six rests and two turns about x: y-forward turns steadily from 630.0 s to 634.8 s.
SLIP = {"rotation_arcsec": [200.0, 300.0, 0.0], "at_s": 632.0, "lasting_s": 0.2}


@pytest.mark.slow
def test_a_slip_in_a_turn_is_one_cause_of_both_sensors_with_its_time() -> None:
    document = chain.short(seed=6, effects={"mounting_slip": SLIP})
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    causes = results["diagnosis/causes"]
    assert causes["cause"].iloc[0] == "mounting_slip"
    assert set(causes["cause"]) <= {"mounting_slip", "oscillation"}
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["mounting_slip"]
    for axis, hidden in zip("xyz", SLIP["rotation_arcsec"], strict=True):
        theta = found.loc[f"theta_{axis}"]
        assert theta["value"] == pytest.approx(hidden * ARC_SECOND, abs=4 * theta["sigma"])
    # The gyros show it in that turn alone, which no other manoeuvre bears out: no usable result
    # has cross terms of neither mounting.
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["accel"] == "usable_within_limits" and verdicts["gyro"] == "not_usable"
    assert found.loc["t0", "value"] == pytest.approx(632.1, abs=4 * found.loc["t0", "sigma"])
