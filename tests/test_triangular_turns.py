"""Turns whose ramps meet, or nearly: no rate is steady in them, and nothing is said of one."""

from math import degrees
from typing import Any

import chain
import numpy as np
import pytest

from inertial.signal.rests_and_motions import steady_part

STEADY_S = {10: 0.0, 10.3: 0.175, 12: 1.0, 15: 2.0}  # by °/s²: 360°/60 °/s less 60 °/s over it


def turning_up(accel_deg_s2: float, **changes: Any) -> dict[str, Any]:
    """Six rests and six turns of 360°, planned at 60 °/s with this acceleration."""
    document = chain.short(**changes)
    for manoeuvre in document["campaign"]["plan"]:
        if manoeuvre["do"] == "turn":
            manoeuvre["accel_deg_s2"] = accel_deg_s2
    return document


@pytest.mark.parametrize("accel_deg_s2", STEADY_S)
def test_a_turn_is_steady_for_as_long_as_its_ramps_leave(accel_deg_s2):
    results = chain.in_memory_of(turning_up(accel_deg_s2), "segment")
    assert results["segment/findings"].empty and results["segment/repairs"].empty
    turns = results["segment/performed"].set_index("manoeuvre").filter(regex="ward", axis=0)
    assert turns["complete"].all() and len(turns) == 6
    segments = results["segment/segments"].query("phase == 'steady'")
    if STEADY_S[accel_deg_s2] < 0.3:  # three of the bins of 0.1 s in which it is sought
        assert segments.empty and turns["rate"].isna().all()
        return
    lasts = segments["to_s"] - segments["from_s"]
    assert (abs(lasts - STEADY_S[accel_deg_s2]) < 0.25).all() and len(segments) == 6
    np.testing.assert_allclose(turns["rate"].map(degrees).abs(), 60.0, rtol=3e-3)


@pytest.mark.slow
def test_a_triangular_turn_calibrates_its_gyro_and_has_no_ripple():
    results = chain.in_memory_of(turning_up(10), "criticism")
    assert results["criticism/findings"].empty
    scale = results.parameters("gyroscope").filter(like="scale", axis=0)
    away = scale["value"] - (np.diag(chain.short()["truth"]["gyro"]["matrix"]) - 1)
    assert (abs(away) < 4 * scale["sigma"]).all() and (scale["sigma"] < 100e-6).all()


def bins_of(table: np.ndarray, noise: float) -> np.ndarray:
    """Rates of a table every ms, as means of bins of 0.1 s with noise, rad/s."""
    means = table[: len(table) // 100 * 100].reshape(-1, 100).mean(axis=1)
    return np.asarray(means + noise * np.random.default_rng(3).standard_normal(len(means)))


def ramps(plateau_s: float, ramp_s: float, rate: float) -> np.ndarray:
    """A trapezoid, sampled every ms, which begins 37 ms before a bin does."""
    time = 1e-3 * np.arange(round(1e3 * (plateau_s + 2 * ramp_s + 0.2))) + 0.037
    return np.asarray(
        rate * np.clip(np.minimum(time, plateau_s + 2 * ramp_s - time) / ramp_s, 0, 1)
    )


@pytest.mark.parametrize("noise_deg_s", [0.0, 0.002, 0.03])
@pytest.mark.parametrize("ramp_s", [1.0, 6.0, 60.0])
def test_the_top_of_a_triangle_is_no_plateau(ramp_s, noise_deg_s):
    rate = bins_of(ramps(0.0, ramp_s, np.radians(60)), np.radians(noise_deg_s))
    first, after = steady_part(-rate)
    assert first == after and abs(0.1 * first - ramp_s) < 0.05 * ramp_s + 0.1


def test_a_rate_that_rises_and_falls_as_a_sine_has_no_plateau():
    time = 1e-3 * np.arange(12_000)
    first, after = steady_part(bins_of(np.sin(np.pi * time / 12), 1e-4))
    assert first == after


def test_a_turn_that_pauses_or_changes_its_rate_is_no_triangle():
    """Then the steady part is all between its ramps, as the bins have its middle rate."""
    slow, fast = np.full(6000, 0.2), np.full(4000, 1.0)
    first, after = steady_part(bins_of(np.concatenate([slow, fast]), 1e-4))
    assert (first, after) == (1, 99)
