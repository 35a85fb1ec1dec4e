"""Faults of a recording are hidden in its logs; each must be named, with its place."""

from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest

import laboratory

SAMPLE = 0.01  # s
ACCEL = 1.07e-3  # m/s², scatter of a reading: 0.0064 m/s/√h at 100 Hz
GYRO = 3.49e-5  # rad/s: 0.012 °/√h
PLACES = np.random.default_rng(4).choice(np.arange(40, 1960), 100, replace=False).tolist()

Fault = dict[str, dict[str, Any]]


def lost(samples: int) -> Fault:
    return {"lose": {"log": "z-down.asc", "line": 700, "samples": samples}}


def dropped(number: int) -> Fault:
    return {"drop": {"log": "y-up.asc", "lines": sorted(PLACES[:number])}}


def spikes(size: float) -> Fault:
    place = {"log": "x-up.asc", "channel": "accel_y", "lines": sorted(PLACES[:50])}
    return {"spikes": place | {"size_m_s2": size}}


def repeated(samples: int) -> Fault:
    return {"repeat": {"log": "y-down.asc", "line": 900, "samples": samples, "stamps": "same"}}


def clipped(limit: float) -> Fault:
    return {"clip": {"log": "z-forward.asc", "channel": "gyro_z", "limit_rad_s": limit}}


def oscillation(amplitude: float) -> Fault:
    place = {"log": "y-up.asc", "channel": "accel_x", "line": 400, "samples": 1100}
    return {"oscillate": place | {"frequency_hz": 37, "amplitude_m_s2": amplitude}}


def step(size: float) -> Fault:
    place = {"log": "x-down.asc", "channel": "gyro_y", "line": 801}
    return {"step": place | {"size_rad_s": size}}


def back(seconds: float) -> Fault:
    return {"turn_back": {"log": "z-up.asc", "line": 1201, "seconds": seconds}}


def dead(samples: int) -> Fault:
    place = {"log": "y-backward.asc", "channel": "gyro_x", "line": 300, "samples": samples}
    return {"kill": place | {"reads": "frozen"}}


def drift(ppm: float) -> Fault:
    return {"drift": {"log": "x-up.asc", "ppm": ppm, "line": 501, "samples": 1000}}


def swapped(samples: int) -> Fault:
    place = {"log": "y-up.asc", "line": 601, "samples": samples}
    return {"swap": place | {"sensor": "accelerometer", "axes": ["x", "y"]}}


# Each at three sizes, the last near what can be seen at all.
HIDDEN = {
    "gap": [lost(1000), lost(20), lost(1)],
    "spike": [spikes(50.0), spikes(0.1), spikes(9 * ACCEL)],
    "duplicate": [repeated(50), repeated(5), repeated(1)],
    "saturation": [clipped(0.9), clipped(1.0472), clipped(1.0472 + 1.5 * GYRO)],
    "oscillation": [oscillation(0.1), oscillation(10 * ACCEL), oscillation(6 * ACCEL)],
    "bias_jump": [step(50 * GYRO), step(10 * GYRO), step(4 * GYRO)],
    "time_backwards": [back(9.0), back(0.5), back(0.02)],
    "dead_axis": [dead(500), dead(100), dead(10)],
    "gap, dropped samples": [dropped(100), dropped(20), dropped(3)],
    "clock_scale": [drift(10_000), drift(500), drift(20)],
    "axis_swap": [swapped(1400), swapped(200), swapped(10)],
}


def hide(faults: list[Fault]) -> tuple[chain.Results, laboratory.Recording]:
    recording = laboratory.perform(laboratory.specify(chain.short(faults=faults)))
    return chain.in_memory(recording, "segment"), recording


def findings(results: chain.Results) -> pd.DataFrame:
    return pd.concat([results["quality/findings"], results["segment/findings"]])


def spoiled(recording: laboratory.Recording, name: str, results: chain.Results):
    """When a fault spoiled its log: from, to, s since the campaign's first sample."""
    epoch = results["decode/clocks"]["epoch_gps"].iloc[0]
    own = [one for one in recording.spoiled if one.fault == name]
    assert len({one.log for one in own}) == 1
    first, last = min(s.first_stamp for s in own), max(s.last_stamp for s in own)
    return own[0].log, first / 1e9 - epoch, last / 1e9 - epoch


def before(recording: laboratory.Recording, name: str, results: chain.Results) -> float:
    """When the last record before a fault was taken, s since the campaign's first sample."""
    first = min((one for one in recording.spoiled if one.fault == name), key=lambda one: one.first)
    stamp = recording.records[first.log].stamps[first.first - 1]
    return float(stamp) / 1e9 - float(results["decode/clocks"]["epoch_gps"].iloc[0])


def assert_named(found: pd.DataFrame, cause: str, place: tuple[str, float, float]) -> None:
    log, start, end = place
    own = found[(found["cause"] == cause) & (found["log"] == log)]
    assert len(own), f"{cause} is not found; found: {list(found['cause'])}"
    assert abs(own["from_s"].min() - start) <= 2.001 * SAMPLE
    assert abs(own["to_s"].max() - end) <= 2.001 * SAMPLE


CASES = [
    pytest.param(
        cause.partition(",")[0],
        fault,
        id=f"{cause}-{number}",
        marks=pytest.mark.slow if number < 2 else (),
    )
    for cause, faults in HIDDEN.items()
    for number, fault in enumerate(faults)
]


@pytest.mark.parametrize(("cause", "fault"), CASES)
def test_a_hidden_fault_is_named_with_its_place_and_nothing_else(cause, fault):
    results, recording = hide([fault])
    found = findings(results)
    (name,) = fault
    log, start, end = spoiled(recording, name, results)
    if cause == "gap":  # what is missing lies between this record and the one before it
        start = before(recording, name, results)
        missing = sum(s["missing"] for _, s in results["quality/gaps"].iterrows())
        assert missing == fault[name].get("samples", len(fault[name].get("lines", [])))
    assert_named(found, cause, (log, start, end))
    assert set(found["cause"]) == {cause}


@pytest.mark.parametrize("sigma", [100.0, 4.0, 0.6])
def test_a_reading_off_once_a_second_is_named_with_its_phase(sigma):
    """One sample of a hundred in twelve logs; at 0.6 sigma none of them can be seen by itself."""
    size = sigma * GYRO
    place = {"log": "all", "channel": "gyro_y", "period_s": 1, "phase_s": 0.31}
    results, recording = hide([{"glitch": place | {"size_rad_s": size}}])
    (found,) = findings(results).itertuples()
    assert (found.cause, found.sensor, found.axis) == ("periodic_glitch", "gyro", "y")
    assert found.sentence.startswith("At 0.310 s of every 1 s the gyro y")
    # It is hidden in whole counts of 1.1e-5 rad/s.
    assert found.size == pytest.approx(size, abs=3 * GYRO / np.sqrt(found.count) + 0.55e-5)
    spoilt = sum(one.after - one.first for one in recording.spoiled)
    assert abs(found.count - spoilt) <= 12  # one more or less where a log begins or ends
    masks = results["quality/masks"]
    assert set(masks["finding"]) == {found.id} and len(masks) == found.count


def gated(limit: float) -> Fault:
    return {"gate": {"log": "all", "channel": "gyro_z", "limit_rad_s": limit}}


@pytest.mark.parametrize("limit", [pytest.param(0.09, marks=pytest.mark.slow), 0.07, 3e-3])
def test_zeros_below_a_threshold_are_one_cause_in_all_logs(limit):
    """Four ramps pass 0.07 rad/s with 40 readings; turns about x and y are read as 5 mrad/s."""
    results, recording = hide([gated(limit)])
    (found,) = findings(results).itertuples()
    assert (found.cause, found.sensor, found.axis) == ("zero_below_threshold", "gyro", "z")
    told = results["quality/channel_statistics"].query("sensor == 'gyro' and axis == 'z'")
    np.testing.assert_allclose(told["threshold"], limit, rtol=0.15)  # 7 mrad/s a sample
    masks = results["quality/masks"]
    assert masks["censored"].all()
    for one in recording.spoiled:
        own = masks[masks["log"] == one.log]
        inside = (own["from_record"] <= one.first) & (own["to_record"] >= one.after)
        assert inside.any()


def test_a_threshold_that_few_readings_pass_is_an_axis_that_stands_still_or_a_firmware():
    """With six readings of the ramps at 0.01 rad/s between it and twice as much."""
    results, _ = hide([gated(0.01)])
    still = findings(results).set_index("cause").loc["dead_axis"]
    assert "firmware writes below a threshold" in still["action"]


COMBINATIONS = [
    (["gap", "spike", "dead_axis"], [lost(20), spikes(0.1), dead(100)]),
    (["bias_jump", "duplicate", "oscillation"], [step(10 * GYRO), repeated(5), oscillation(0.01)]),
    (["axis_swap", "saturation", "clock_scale"], [swapped(200), clipped(1.0472), drift(500)]),
    (["gap", "time_backwards", "bias_jump"], [dropped(20), back(0.5), step(50 * GYRO)]),
    (["spike", "clock_scale", "oscillation"], [spikes(0.1), drift(500), oscillation(0.1)]),
]


@pytest.mark.parametrize(("causes", "faults"), COMBINATIONS)
def test_three_faults_at_once_are_named_all_three(causes, faults):
    results, recording = hide(faults)
    found = findings(results)
    for cause, fault in zip(causes, faults, strict=True):
        if cause != "gap":
            assert_named(found, cause, spoiled(recording, *fault, results))
    assert set(found["cause"]) == set(causes)


# ---- silence


def hard(number: int) -> dict[str, Any]:
    """Clean campaigns, none like the other: what is no fault must not be taken for one."""
    document = chain.short(seed=1000 + number)
    noise, truth = document["noise"], document["truth"]
    generator = np.random.default_rng(number)
    if number % 4 == 1:  # drift of the biases
        noise["gyro_rate_random_walk_deg_h_sqrt_h"] = 0.3
        noise["accelerometer_random_walk_m_s2_sqrt_h"] = 3e-4
    if number % 4 == 2:  # noise that depends on attitude, as S0's
        noise["table_sway_m_s_sqrt_h"] = [0.036, 0.006]
    if number % 4 == 3:  # mounted askew
        axis = generator.normal(size=3)
        x, y, z = np.radians(5) * axis / np.linalg.norm(axis)
        askew = np.eye(3) + np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        for sensor in ("accelerometer", "gyro"):
            truth[sensor]["matrix"] = (np.array(truth[sensor]["matrix"]) @ askew).tolist()
    for key in ("angle_random_walk_deg_sqrt_h", "velocity_random_walk_m_s_sqrt_h"):
        noise[key] *= float(generator.uniform(0.7, 8.0))
    return document


@pytest.mark.parametrize(
    "numbers",
    [range(3), pytest.param(range(3, 100), marks=pytest.mark.slow)],
    ids=["three", "ninety-seven"],
)
def test_clean_campaigns_raise_no_finding(numbers):
    for number in numbers:
        recording = laboratory.perform(laboratory.specify(hard(number)))
        found = findings(chain.in_memory(recording, "segment"))
        assert found.empty, (number, found[["cause", "sentence"]].to_dict("records"))
