"""Turns whose angle is short for their rate: by samples that are lost, or by the gyro's reading."""

from dataclasses import replace
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
