"""Turns whose angle is short for their rate: by samples that are lost, or by the gyro's reading."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pytest

import laboratory


def at_two_rates(**changes: Any) -> dict[str, Any]:
    """Six rests, and turns of 360° both ways about each axis at 20 and 60 °/s, by 40 °/s²."""
    document = chain.short(**changes)
    document["campaign"]["table"] |= {"rate_sigma_ppm": 100}
    plan = document["campaign"]["plan"]
    for turn in [one for one in plan if one["do"] == "turn"]:
        slow = turn["id"] + "-slow"
        turn |= {"accel_deg_s2": 40}
        plan.append(turn | {"id": slow, "log": slow + ".asc", "rate_deg_s": 20})
    return document


def with_dead_zone(recording: laboratory.Recording, width: float, axis: int):
    """The recording by a gyro that reads every rate nearer to zero by a width, rad/s, at most.

    And noise of its own, without which it would not change at rest.
    """
    records, random = {}, np.random.default_rng(8)
    most = width * 0.01 / recording.receiver.gyro_count
    for log, one in recording.records.items():
        counts = one.counts.astype(float)
        own = counts[:, 3 + axis]
        left = np.sign(own) * np.maximum(np.abs(own) - most, 0.0)
        counts[:, 3 + axis] = np.rint(left + 3.0 * random.standard_normal(len(own)))
        records[log] = replace(one, counts=counts.astype(one.counts.dtype))
    return replace(recording, records=records)


@pytest.mark.slow
@pytest.mark.parametrize("about", range(3))
def test_a_dead_zone_loses_no_samples(about):
    """At 60 °/s 0.3 °/s is 0.5 % of the rate and 0.6 % of the angle, ramps included: 0.1 % less."""
    recording = laboratory.perform(laboratory.specify(at_two_rates(seed=3)))
    results = chain.in_memory(with_dead_zone(recording, np.radians(0.3), about), "segment")
    turned = results["segment/performed"].set_index("manoeuvre")["angle"].map(np.degrees)
    axis = "xyz"[about]
    # 360° less 0.3 °/s times 7.5 s and 18.5 s: both ramps and what is left at the rate.
    assert turned[f"{axis}-forward"] == pytest.approx(357.8, abs=0.6)
    assert turned[f"{axis}-forward-slow"] == pytest.approx(354.4, abs=0.6)
    assert "samples_lost" not in set(results["segment/findings"]["cause"])


def without_samples(document: dict[str, Any], folder: Path, log: str, lost: int) -> chain.Results:
    """A campaign whose samples are counted at 100 Hz, some of them lost in the middle of a log."""
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    campaign = chain.simulate(document, folder / "campaign")
    stated = campaign / "campaign.yaml"
    by_stamp, by_number = "time: {column: time, unit: s}", "time: {rate_hz: 100}"
    assert by_stamp in stated.read_text()
    stated.write_text(stated.read_text().replace(by_stamp, by_number))
    lines = (campaign / log).read_text().splitlines(keepends=True)
    middle = len(lines) // 2
    (campaign / log).write_text("".join(lines[:middle] + lines[middle + lost :]))
    return chain.run(campaign, folder / "derived", "gyroscope")


@pytest.mark.slow
def test_one_turn_that_lacks_samples_may_be_the_table_or_the_log(tmp_path):
    """100 samples at 10 °/s are 10.00°; bias and earth read 0.2° more in the 37 s of the turn."""
    document = chain.short(seed=4)
    document["campaign"]["site"]["latitude_deg"] = 47.4
    document["truth"]["gyro"]["bias_rad_s"] = [1.17e-4, 1.47e-4, 0.56e-4]
    for turn in document["campaign"]["plan"][6:]:
        turn |= {"rate_deg_s": 10, "accel_deg_s2": 10}
    results = without_samples(document, tmp_path, "z-forward.asc", 100)
    (found,) = results["gyroscope/findings"].to_dict("records")
    assert (found["cause"], found["manoeuvre"]) == ("turn_angle_error", "z-forward")
    assert np.degrees(found["size"]) == pytest.approx(-10.0, abs=0.03)
    assert "by 350.0°, not by 360.0°, or samples are lost in it" in found["sentence"]
    assert "correct the angle of the plan" in found["action"] and "record it" in found["action"]


@pytest.mark.slow
def test_a_turn_that_goes_too_far_lacks_no_samples():
    document = chain.short(
        seed=4, effects={"turn_angle_error": {"turn": "z-forward", "further_arcsec": 18000}}
    )
    results = chain.in_memory_of(document)
    (found,) = results["gyroscope/findings"].to_dict("records")
    assert np.degrees(found["size"]) == pytest.approx(5.0, abs=0.03)
    assert "by 365.0°" in found["sentence"] and "samples" not in found["sentence"]
