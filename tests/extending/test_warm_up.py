"""The time after which a bias has warmed up, against what its law says."""

from dataclasses import replace
from typing import cast

import chain
import numpy as np
import pytest

from inertial.effects import CATALOGUE
from inertial.estimation.least_squares import Estimate
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.motion import Motion, stretches
from stages.extension.after_switch_on import warm_up_rows
from stages.extension.estimates import Solved

AMPLITUDE, SIGMA, CONSTANT, BAND = 5e-3, 1e-4, 900.0, 1e-4  # m/s², m/s², s, m/s²


def motion(temperature: float = np.nan) -> Motion:
    time = np.arange(5.0, 14400.0, 10.0)
    return stretches(time, np.full(len(time), 10.0), np.full(len(time), temperature))


def solved() -> Solved:
    """Only x warms up."""
    rows = [{"parameter": str(i), "value": 0.0, "sigma": 1.0} for i in range(UNKNOWNS)]
    rows += [
        {"parameter": f"accel_warm_up.b_{axis}", "value": value, "sigma": SIGMA}
        for axis, value in zip("xyz", (AMPLITUDE, 0.0, 0.0), strict=True)
    ]
    covariance = np.diag([1.0] * UNKNOWNS + [SIGMA**2] * 3)
    return Solved("accel", rows, covariance, cast(Estimate, None), 0.0)


def test_an_exponential_settles_after_its_time():
    """|b| e^(−t/τ) = band at t = τ ln(|b|/band), and σ(t) = τ σ(b)/b."""
    effect = CATALOGUE["accel_warm_up"].fixed(CONSTANT)
    x, y, z = warm_up_rows(solved(), [effect], motion(), BAND)
    assert x["seconds"] == pytest.approx(CONSTANT * np.log(AMPLITUDE / BAND), abs=2.0)
    assert x["sigma"] == pytest.approx(CONSTANT * SIGMA / AMPLITUDE, rel=0.05)
    assert "stays within 10 µg of its last value from 3521 ± 18 s on" in x["sentence"]
    assert y["seconds"] == z["seconds"] == 0.0


def test_after_each_switch_on_it_settles_after_the_same_time():
    effect, once = CATALOGUE["accel_warm_up"].fixed(CONSTANT), motion()
    twice = replace(once, switched_on=np.where(once.time > 7200, 7200.0, 0.0))
    x, *_others = warm_up_rows(solved(), [effect], twice, BAND)
    last = np.exp(-7200 / CONSTANT)  # of the amplitude, at the end of each run
    settled = -CONSTANT * np.log(BAND / AMPLITUDE + last)
    assert x["seconds"] == pytest.approx(settled, abs=2.0)
    with_temperature = [effect, CATALOGUE["accel_bias_temperature"]]
    warm = replace(twice, temperature=np.full(len(once.time), 300.0))
    assert not list(warm_up_rows(solved(), with_temperature, warm, BAND))


def test_what_never_settles_has_no_time():
    effect = CATALOGUE["accel_warm_up"].fixed(20 * CONSTANT)
    x, *_others = warm_up_rows(solved(), [effect], motion(), BAND)
    assert x["seconds"] is None and "does not settle" in x["sentence"]


def test_a_chamber_that_cools_is_no_warm_up():
    effect = CATALOGUE["accel_warm_up"].fixed(CONSTANT)
    cooling = replace(motion(), temperature=np.linspace(320, 300, len(motion().time)))
    assert not list(warm_up_rows(solved(), [effect], cooling, BAND))


@pytest.mark.slow
def test_a_warm_up_after_each_switch_on_is_found_in_logs_that_share_no_clock(tmp_path):
    """A day apart, each from its switch-on: once it was a jump, and a g-sensitivity."""
    hidden = {"gyro_warm_up": {"start_deg_h": [9, 0, -6], "time_constant_s": 60}}
    hidden["turn_on_bias"] = {"gyro_deg_h": 4, "accelerometer_micro_g": 100}
    document = chain.short(effects=hidden, seed=78)
    document["start"]["pause_s"] = 86_400.0
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up", "rate_hz": 100}
    document["handling"] |= {"still_s": 5, "change_s": 10}
    plan = document["campaign"]["plan"]
    plan = [one for pair in zip(plan[:6], plan[6:], strict=True) for one in pair]  # rest, turn, …
    document["campaign"]["plan"] = plan
    for number, each in enumerate(plan):
        each |= {"log": f"part-{number // 6}.csv", "power_cycle": number == 6}
    raw = chain.simulate(document, tmp_path / "raw")
    made = chain.run(raw, tmp_path / "derived", "compensation", chain.BESIDE)
    assert made["diagnosis/causes"]["cause"].tolist() == ["gyro_warm_up"]
    assert set(made["diagnosis/verdict"]["verdict"]) == {"usable_within_limits", "usable"}
    result = made["diagnosis/result"].set_index("parameter")
    for axis, true in zip("xyz", np.radians([9, 0, -6]) / 3600, strict=True):
        found = result.loc[f"gyro_warm_up.b_{axis}"]
        assert found["value"] == pytest.approx(true, abs=4 * found["sigma"])
    assert result.loc["gyro_warm_up.tau", "value"] == pytest.approx(60, rel=0.3)
    assert "gyro_warm_up.on_1" not in result.index  # time counts anew in each log
