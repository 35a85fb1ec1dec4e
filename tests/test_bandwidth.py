"""Bandwidths that the laboratory hides in the output of gyros, and limits where there are none."""

from copy import deepcopy

import chain
import numpy as np
import pytest
from scipy import stats

import laboratory
from inertial.estimation.bandwidth import by_noise, first_order, spread_by_ramps
from inertial.estimation.encoder_angle import against_encoder
from inertial.estimation.multiresolution import WelchSums, segment_for
from inertial.estimation.time_angle import Valued

SOURCE = chain.ROOT / "data/simulated/encoder.yaml"
STEP, COUNT = 0.005, 1e-8  # s; rad
WALK = np.radians(0.012) / 60  # rad/√s
DRAWS = 24
# Of a filter that takes one value for each sample: delays of τ² in continuous time, and of T²/6.
SAMPLED = STEP**2 / 6  # s²


def turned(tau_ms, seed):
    """Rates and angles of the encoder in a turn about z with ramps of 1 s at 20 °/s²."""
    document = deepcopy(laboratory.read(SOURCE).document)
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [plan[4], plan[10]]
    document["effects"] = {"gyro_low_pass": {"time_constant_ms": [0, 0, tau_ms]}}
    records = laboratory.perform(laboratory.specify(document | {"seed": seed})).records
    record = records["z-forward.csv"]
    return record.counts[:, 5] * COUNT / STEP, np.unwrap(record.table_angle)


def spreads(tau_ms):
    """Of some draws κ by the encoder and κ by the ramps alone."""
    for seed in range(DRAWS):
        rates, angle = turned(tau_ms, seed)
        yield (
            against_encoder(rates, angle, STEP, WALK).spread,
            spread_by_ramps(rates, STEP, WALK),
        )


@pytest.mark.slow
def test_a_hidden_low_pass_comes_back_within_its_sigma():
    pulls = []
    for tau in (8.0, 20.0):
        truth = (tau * 1e-3) ** 2 + SAMPLED
        pulls += [[(each.value - truth) / each.sigma for each in both] for both in spreads(tau)]
    # Three sigma of an rms of so many draws.
    margin = 3 / np.sqrt(2 * len(pulls))
    assert np.sqrt(np.mean(np.square(pulls), axis=0)) == pytest.approx(1, abs=margin)
    assert np.abs(np.mean(pulls, axis=0)).max() < 3 / np.sqrt(len(pulls))


def test_where_ramps_are_too_slow_a_limit_holds():
    """τ of 1 ms is an angle of 0.04″ in these ramps; the truth is below the limit in one of 20."""
    truth = 1 / (2 * np.pi * np.sqrt(1e-6 + SAMPLED))
    limits = [[first_order(each) for each in both] for both in spreads(1.0)]
    for by in zip(*limits, strict=True):
        assert sum(each.value is None for each in by) > 0.8 * DRAWS
        below = sum(each.lower is not None and each.lower > truth for each in by)
        assert stats.binom.sf(below - 1, DRAWS, 0.05) > 1e-3
        assert np.median([each.lower for each in by if each.lower]) > 40


def test_the_bandwidth_of_a_time_constant():
    """τ = 20 ms: 7.958 Hz; the sigma of τ² of 2 % is 1 % of it."""
    found = first_order(Valued(4e-4, 8e-6))
    assert found.value == pytest.approx(7.9577, abs=1e-4)
    assert found.sigma == pytest.approx(0.079577, abs=1e-5)
    assert found.lower == pytest.approx(7.9577 / np.sqrt(1 + 1.645 * 0.02), rel=1e-4)
    assert first_order(Valued(-3e-6, 1e-6)).lower is None


def test_a_drive_that_rounds_its_corners_makes_the_limit_lower():
    """Ramps of 0.5 s through a drive of 15 ms and a gyro of 5 ms: variances add up."""
    rates, _angle = turned(0.0, 3)
    fine = 0.0005
    time = fine * np.arange(len(rates) * 10)
    speed = np.radians(20) * np.clip(np.minimum(time - 2, 15 - time) / 0.5, 0, 1)
    for tau in (0.015, 0.005):
        share = 1 - np.exp(-fine / tau)
        passed = np.zeros(len(speed))
        for i in range(1, len(speed)):
            passed[i] = passed[i - 1] + share * (speed[i] - passed[i - 1])
        speed = passed
    noise = WALK / np.sqrt(STEP) * np.random.default_rng(3).standard_normal(len(rates))
    spread = spread_by_ramps(speed.reshape(-1, 10).mean(axis=1) + noise, STEP, WALK)
    assert spread.value == pytest.approx(0.015**2 + 0.005**2, abs=4 * spread.sigma)
    assert first_order(spread).lower < 1 / (2 * np.pi * 0.005)


def welch(values):
    sums = WelchSums(1, STEP, segment_for([len(values)]))
    sums.add(values[:, None])
    found = sums.spectrum()
    return found.frequency, found.density[:, 0], found.degrees


@pytest.mark.slow
def test_noise_behind_a_low_pass_tells_its_bandwidth():
    """Whether it is filtered before or behind sampling is not known: that is in the sigma."""
    document = deepcopy(laboratory.read(SOURCE).document)
    rest = document["campaign"]["plan"][4] | {"seconds": 120}
    document["campaign"]["plan"] = [rest]
    document["effects"] = {"gyro_low_pass": {"time_constant_ms": [8, 20, 0]}}
    pulls, limits = [], []
    for seed in range(DRAWS):
        records = laboratory.perform(laboratory.specify(document | {"seed": seed})).records
        rates = records["z-up.csv"].counts[:, 3:] * COUNT / STEP
        found = [by_noise(*welch(column), STEP) for column in rates.T]
        truth = 1e3 / (2 * np.pi * np.array([8, 20]))
        pulls.append([(f.value - t) / f.sigma for f, t in zip(found, truth, strict=False)])
        limits.append(found[2])
    assert np.sqrt(np.mean(np.square(pulls), axis=0)).max() < 1.5
    assert np.abs(pulls).max() < 4
    assert all(limit.value is None and limit.lower > 40 for limit in limits)


@pytest.mark.slow
def test_every_axis_has_its_bandwidth_and_says_what_it_is_of():
    document = deepcopy(laboratory.read(SOURCE).document)
    document["effects"] |= {"gyro_low_pass": {"time_constant_ms": [8, 20, 0]}}
    rows = chain.in_memory_of(document, "studies")["studies/bandwidths"]
    rows = rows.set_index(["sensor", "axis", "by"]).sort_index()
    for axis, tau in (("x", 8e-3), ("y", 20e-3)):
        row = rows.loc["gyro", axis, "encoder"]
        truth = 1 / (2 * np.pi * np.sqrt(tau**2 + SAMPLED))
        assert row["value"] == pytest.approx(truth, abs=4 * row["sigma"])
        assert row["lower"] < row["value"] and row["turns"] == 2
        # The ripple of the drive and its corners are in what the gyro alone reads.
        assert rows.loc["gyro", axis, "ramps"]["lower"] < truth
        assert rows.loc["gyro", axis, "noise"]["value"] == pytest.approx(truth, rel=0.25)
    none = rows.loc["gyro", "z", "encoder"]
    assert np.isnan(none["value"]) and none["lower"] > 40
    assert rows.loc["accel", "x", "ramps"]["reason"]
