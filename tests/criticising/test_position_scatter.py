"""A table whose positions are worse than is stated: that is named, and no effect of a sensor."""

from dataclasses import replace
from typing import Any

import chain
import numpy as np
import pytest
from hidden_plans import PLANS

import laboratory
from inertial.estimation.triad import linear_names
from inertial.text.units import ARC_SECOND

CLEAR = ("found", "one_of_class", "law")


def criticised(seed: int, tilted: str, sigma: float, stated: float | None = None) -> chain.Tables:
    """Positions that are `sigma` off, arcsec, where the campaign states as much, or another."""
    document = PLANS["stops"](seed=seed)
    document["campaign"]["table"] |= {"position_sigma_arcsec": stated or sigma}
    document["truth"] |= {"tilted": tilted}
    beyond = np.sqrt(sigma**2 - (stated or sigma) ** 2)
    effects: dict[str, Any] = {"table_position_error": {"sigma_arcsec": float(beyond)}}
    document["effects"] = effects if beyond else {}
    recording = laboratory.perform(laboratory.specify(document))
    return chain.in_memory(recording, "criticism", chain.BESIDE)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "tilted"), [(73, "case"), (72, "axis")])
def test_positions_worse_than_stated_are_named_and_nothing_else(seed: int, tilted: str) -> None:
    results = criticised(seed, tilted, 60.0, 2.0)
    (found,) = results["criticism/findings"].query("verdict in @CLEAR").to_dict("records")
    assert (found["cause"], found["verdict"]) == ("position_scatter", "found")
    # Of six positions with two tilts each the standard deviation is known to a fifth.
    assert found["size"] / ARC_SECOND == pytest.approx(60, rel=0.5)
    if tilted == "axis":  # what moves the axis with the case is not seen by gyros
        assert found["sensor"] == "accel"
    assert "position_sigma_arcsec" in found["action"]


@pytest.mark.slow
@pytest.mark.parametrize("tilted", ["case", "axis"])
def test_with_their_sigma_stated_they_are_no_cause_and_the_sigmas_hold(tilted: str) -> None:
    results = criticised(71, tilted, 60.0)
    assert not results["criticism/findings"]["verdict"].isin(CLEAR).any()
    document = PLANS["stops"](seed=71)
    for stage, truth in (("accelerometer", "accelerometer"), ("gyroscope", "gyro")):
        table = results.parameters(stage, "joint")
        true = (np.array(document["truth"][truth]["matrix"]) - np.eye(3)).ravel()
        own = table.loc[list(linear_names())[:9]]
        errors = (own["value"].to_numpy(float) - true) / own["sigma"].to_numpy(float)
        assert np.abs(errors).max() < 4.0


@pytest.mark.slow
def test_rests_of_one_position_that_were_set_anew_are_no_random_walk() -> None:
    """A random walk of the accelerometers was named; cross terms 5 sigma off were usable."""
    document = PLANS["stops"](seed=74)
    plan = document["campaign"]["plan"]
    kept = [dict(one) for one in plan]
    for i, one in enumerate(plan):  # the laboratory sets each manoeuvre anew, by 30 arcsec
        one["position"] = f"{i}"
    document["effects"] = {"table_position_error": {"sigma_arcsec": 30.0}}
    recording = laboratory.perform(laboratory.specify(document))
    stated = {**recording.campaign, "plan": kept}
    results = chain.in_memory(replace(recording, campaign=stated), "segment", chain.BESIDE)
    (found,) = results["segment/findings"].query("cause == 'position_not_kept'").to_dict("records")
    assert found["count"] == 6 and found["size"] / ARC_SECOND == pytest.approx(42, rel=0.3)
    kept_so = chain.in_memory(recording, "segment", chain.BESIDE)["segment/findings"]
    assert "position_not_kept" not in set(kept_so["cause"])


def test_a_table_that_shakes_sideways_keeps_its_positions() -> None:
    """Means of 3.5 s differ across gravity by its shaking, and hardly along gravity."""
    document = PLANS["stops"](seed=2_026_113_007_000_026)  # where it was named
    document["noise"]["table_sway_m_s_sqrt_h"] = [0.0184, 0.0205]
    results = chain.in_memory_of(document, "segment", chain.BESIDE)
    assert "position_not_kept" not in set(results["segment/findings"]["cause"])
