"""Counts that are coarse beside the noise, and do not carry over what they leave."""

from itertools import product

import chain
import numpy as np
import pandas as pd
import pytest
from judge import parameters_of
from scipy.stats import norm

from inertial.estimation.noise_model import sigma_of_mean
from inertial.sensors import CHANNELS
from inertial.signal.scatter import noise_before_rounding, rounded_mean
from stages.noise.rounding import carried_rounding, rounding_levels
from stages.noise.spectra import Spectra

SEEDS = (1801, 1802, 1803)


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.2, 0.3])
def test_the_mean_of_rounded_readings_is_off_however_many_they_are(noise):
    random = np.random.default_rng(4)
    truth = random.uniform(size=2000)
    readings = np.rint(truth[:, None] + random.normal(0, noise, (2000, 4000)))
    off = np.std(readings.mean(axis=1) - truth)
    assert off == pytest.approx(rounded_mean(noise), rel=0.05, abs=3e-3)
    assert noise_before_rounding(np.mean(readings.var(axis=1))) == pytest.approx(noise, abs=0.01)


def rounded(seed: int, noise: float, *, carries: bool) -> dict:
    """The short campaign as columns of counts, the noise of a sample being `noise` of them."""
    document = chain.short(seed=seed)
    document["receiver"] |= {"message": "columns", "line_end": "lf", "carries": carries}
    document["receiver"]["gyro_count_rad"] = 3.5e-5 * 0.01 / noise
    document["receiver"]["accelerometer_count_m_s"] = 1.07e-3 * 0.01 / noise
    document["campaign"]["instrument"] = {"name": "made up"}
    return document


@pytest.fixture(
    scope="module",
    params=[
        0.3,
        0.15,
        0.02,
    ],
)
def results(request):
    """Of each seed what was hidden and what came of it."""
    documents = [rounded(seed, request.param, carries=False) for seed in SEEDS]
    return [(one, chain.in_memory_of(one, "diagnosis", chain.BESIDE)) for one in documents]


@pytest.mark.slow
def test_they_are_the_only_cause_and_the_result_stays_usable(results):
    """Once effects of the gyros were "found" at 10 sigma, and of accelerometers beside them.

    With a noise of 1/50 of a count all readings of a rest are equal.
    """
    for _, tables in results:
        causes = tables["diagnosis/causes"]
        assert set(causes["cause"]) == {"quantisation"} and set(causes["sensor"]) == {
            "gyro",
            "accel",
        }
        assert set(tables["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}


@pytest.mark.slow
def test_the_sigmas_hold_what_rounding_makes_the_means_uncertain_by(results):
    pulls = []
    for document, tables in results:
        result = tables["diagnosis/result"].set_index(["sensor", "parameter"])
        for sensor, truth in parameters_of(document).items():
            own = result.loc[sensor]
            own = own.loc[list(truth)]
            pulls += [*((own["value"] - list(truth.values())) / own["sigma"])]
    assert np.max(np.abs(pulls)) < 4 and 0.2 < np.sqrt(np.mean(np.square(pulls))) < 1.3


@pytest.mark.slow
def test_counts_that_carry_lose_nothing():
    """A receiver of increments says so; what it rounds is in the next count."""
    levels = chain.in_memory_of(chain.short(), "noise")["noise/levels"]
    assert levels["rounding"].isna().all()


def test_a_sum_of_counts_that_carry_is_off_by_what_is_left_at_its_edges():
    """A ring-laser gyro of 0.6″ and 0.002 °/√h: the rounding of an angle is no noise of a rate."""
    random, interval, count = np.random.default_rng(9), 0.01, 3e-6
    angle = np.cumsum(random.uniform(1e-4, 2e-3, 400)[:, None] * np.ones(3000), axis=1)
    noise = np.cumsum(random.normal(0, 6e-8, angle.shape), axis=1)
    readings = np.diff(np.floor((angle + noise) / count), axis=1) * count / interval
    off = readings.sum(axis=1) * interval - (angle[:, -1] - angle[:, 0])
    spectra = {}
    for number, own in enumerate(readings[:8]):
        spectra[f"m{number}", "rest"] = Spectra()
        spectra[f"m{number}", "rest"].add(np.repeat(own[:, None], 6, 1), 100.0, (0.5, 5.0))
        spectra[f"m{number}", "rest"].carried = {"gyro"}
    white = pd.DataFrame({"channel": CHANNELS, "white_noise": 6e-7})
    found = carried_rounding(spectra, np.full(6, count / interval), white)
    assert set(found) == {"gyro_x", "gyro_y", "gyro_z"}
    sigma = sigma_of_mean(6e-7, found["gyro_x"], 30.0) * 30.0
    assert np.std(off) == pytest.approx(sigma, rel=0.1)
    noisy = white.assign(white_noise=6e-5)
    assert not carried_rounding(spectra, np.full(6, count / interval), noisy)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [12, 13])
def test_a_ring_laser_gyro_is_calibrated_within_its_sigmas(seed):
    """It was "4.6 times as large as noise", and not usable."""
    document = chain.demo(seed=seed, effects={})
    document["noise"] |= {"angle_random_walk_deg_sqrt_h": 0.002}
    receiver = document["receiver"]
    receiver["gyro_count_rad"] = 3e-6
    document["campaign"]["instrument"] = {
        "name": "made up",
        "rate_hz": 100,
        "axes": ["z", "-y", "x"],
        "format": {"kind": "rawimus"},
        "gyro": {"count_rad": 3e-6},
        "accelerometer": {"count_m_s": receiver["accelerometer_count_m_s"]},
    }
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    # Beats of the counts look like ripples of 0.02″, which move nothing.
    assert set(results["diagnosis/causes"]["cause"]) <= {"quantisation", "table_ripple"}
    assert set(results["diagnosis/verdict"]["verdict"]) <= {"usable", "usable_within_limits"}
    own = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    true = parameters_of(document)["gyro"]
    pulls = (own.loc[list(true), "value"] - list(true.values())) / own.loc[list(true), "sigma"]
    assert np.abs(pulls).max() < 3.5


@pytest.mark.slow
def test_a_level_of_its_own_for_each_mean_that_rounding_reaches(results):
    _, tables = results[0]
    levels = tables["noise/levels"].dropna(subset="rounding")
    rests = tables["segment/segments"].query("phase == 'rest'")["manoeuvre"]
    channels = tables["noise/levels"]["channel"].unique()
    known = set(zip(levels["manoeuvre"], levels["channel"], strict=True))
    assert set(product(rests, channels)) <= known


def test_a_channel_that_is_masked_in_one_manoeuvre_has_its_levels_in_the_others():
    random, spectra = np.random.default_rng(6), {}
    for number in range(4):
        readings = np.rint(random.normal(random.uniform(size=6), 0.2, (1000, 6)))
        readings[:, 3] = np.nan if number == 0 else readings[:, 3]
        spectra[f"m{number}", "rest"] = Spectra()
        spectra[f"m{number}", "rest"].add(readings, 100.0, (0.5, 5.0))
    levels = rounding_levels(spectra, np.ones(6))
    assert {key[0] for key in levels if key[2] == "gyro_x"} == {"m1", "m2", "m3"}
    assert len(levels) == 23 and np.isfinite(list(levels.values())).all()


def test_an_axis_that_reads_nothing_says_nothing_of_the_others():
    random, spectra = np.random.default_rng(8), {}
    for number in range(4):
        readings = np.rint(random.normal(random.uniform(size=6), 0.4, (1000, 6)))
        readings[:, 5] = 0.0
        spectra[f"m{number}", "rest"] = Spectra()
        spectra[f"m{number}", "rest"].add(readings, 100.0, (0.5, 5.0))
    levels = rounding_levels(spectra, np.ones(6))
    gyro = [size for (_, _, channel), size in levels.items() if channel in ("gyro_x", "gyro_y")]
    assert max(gyro) < 3 * rounded_mean(0.4) * np.sqrt(40)


@pytest.mark.parametrize("noise", [0.05, 0.15, 0.3])
def test_means_that_all_stand_at_one_place_between_two_counts(noise):
    """Half-way readings change with next to no noise: the errors were up to ten of their sigmas."""
    random, steps, seconds, pulls = np.random.default_rng(7), np.arange(-5, 6), 20.0, []
    for _ in range(100):
        truth = random.uniform(-0.5, 0.5, 6)
        edges = norm.cdf((np.append(steps - 0.5, 5.5) - truth[:, None]) / noise)
        share = np.diff(edges)  # of the readings at each count
        mean = share @ steps
        own = Spectra()
        own.samples = {"accel": 2000, "gyro": 2000}
        own.seconds = {"accel": [seconds], "gyro": [seconds]}
        own.sums, own.squares = 2000 * mean, 2000 * (share @ steps**2 - mean**2)
        levels = rounding_levels({("m", "rest"): own}, np.ones(6))
        sigma = [levels.get(("m", "rest", name), 1e-3) / np.sqrt(seconds) for name in CHANNELS]
        pulls.append((mean - truth) / np.maximum(sigma, 1e-3))
    assert 0.6 < np.sqrt(np.mean(np.square(pulls))) < 1.1
    assert np.mean(np.abs(pulls) > 3) < 0.03
