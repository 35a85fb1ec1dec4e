"""The effective noise levels: what is common to a campaign, and what differs from it."""

import numpy as np
import pandas as pd
import pytest

from inertial.campaign.noise_levels import NoiseLevels, effective_levels

TRUE, RELATIVE = 2e-5, 0.05  # rad/√s; sigma of each level


@pytest.fixture(scope="module")
def levels() -> pd.DataFrame:
    rng = np.random.default_rng(4)
    white = np.append(TRUE * (1 + rng.normal(0, RELATIVE, 20)), 1.5 * TRUE)
    measured = pd.DataFrame(
        {
            "manoeuvre": [f"m{i}" for i in range(21)],
            "phase": ["rest"] * 20 + ["steady"],
            "channel": "gyro_x",
            "white_noise": white,
            "sigma": RELATIVE * white,
            "per_sample": np.append(10 * white[:20], 50 * white[20]),
        }
    )
    return effective_levels(measured)


def test_the_common_level_is_known_as_well_as_the_mean_of_all_that_share_it(levels):
    common = levels[levels["manoeuvre"].isna()].iloc[0]
    assert common["sigma"] / common["white_noise"] == pytest.approx(RELATIVE / 20**0.5, rel=1e-9)
    assert abs(common["white_noise"] - TRUE) < 3 * common["sigma"]
    # A level from ν degrees of freedom is known to 1/√(2ν).
    assert common["degrees"] == pytest.approx(20 / (2 * RELATIVE**2))
    assert NoiseLevels(levels).degrees == common["degrees"]


def test_what_differs_by_more_than_chance_keeps_its_own_level(levels):
    own = levels[levels["source"] == "own"]
    assert list(own["manoeuvre"]) == ["m20"]
    assert own["white_noise"].item() == pytest.approx(1.5 * TRUE)
    assert own["degrees"].item() == pytest.approx(1 / (2 * RELATIVE**2))
    effective = NoiseLevels(levels)
    elsewhere = effective.of("m99", "rest", ["gyro_x", "gyro_y"])
    assert elsewhere[0] == effective.of("m3", "rest", ["gyro_x"])[0] != levels["measured"][4]
    assert np.isnan(elsewhere[1])
    assert effective.oscillates("m20", ["gyro_x"]) and not effective.oscillates("m3", ["gyro_x"])


def test_of_short_rests_no_level_is_its_own_by_chance():
    rng, degrees, rests = np.random.default_rng(5), 10, 100
    own, common = [], []
    for _ in range(40):
        white = TRUE * np.sqrt(rng.chisquare(degrees, rests) / degrees)
        measured = pd.DataFrame({"manoeuvre": range(rests), "phase": "rest", "channel": "gyro_x"})
        measured = measured.assign(white_noise=white, sigma=white / np.sqrt(2 * degrees))
        levels = effective_levels(measured.assign(per_sample=white))
        own.append(np.sum(levels["source"] == "own"))
        common.append(levels["white_noise"].iloc[0])
    assert np.sum(own) <= 2  # of 4000, where 3.5 % are below the mean by three sigma of their own
    assert np.mean(common) == pytest.approx(TRUE, rel=0.012)  # a mean of roots is 2.5 % too low


@pytest.mark.parametrize(("degrees", "apart"), [(10, 0.3), (60, 0.1)])
def test_levels_that_scatter_are_nearer_to_the_truth_than_their_own_and_the_common_one(
    degrees, apart
):
    """Log-normal levels, as on a table that shakes sideways, in many attitudes."""
    rng, count = np.random.default_rng(6), 100
    errors: dict[str, list[np.ndarray]] = {"effective": [], "measured": [], "common": []}
    pulls = []
    for _ in range(20):
        true = TRUE * np.exp(rng.normal(0, apart, count))
        white = true * np.sqrt(rng.chisquare(degrees, count) / degrees)
        measured = pd.DataFrame({"manoeuvre": range(count), "phase": "rest", "channel": "gyro_x"})
        measured = measured.assign(white_noise=white, sigma=white / np.sqrt(2 * degrees))
        levels = effective_levels(measured.assign(per_sample=white))
        common, own = levels["white_noise"].iloc[0], levels.iloc[1:]
        assert (own["source"] != "common").all()
        for name, values in (("effective", own["white_noise"]), ("measured", white)):
            errors[name].append(np.log(np.asarray(values, float) / true))
        errors["common"].append(np.log(common / true))
        pulls.append(errors["effective"][-1] * np.sqrt(2 * own["degrees"].to_numpy(float)))
    rms = {name: float(np.sqrt(np.mean(np.square(one)))) for name, one in errors.items()}
    best = 1 / np.sqrt(1 / apart**2 + 2 * degrees)  # of a Gaussian and its prior
    assert rms["effective"] < 1.1 * best < min(rms["measured"], rms["common"])
    assert np.sqrt(np.mean(np.square(pulls))) == pytest.approx(1.0, abs=0.15)


def test_a_manoeuvre_without_a_level_of_a_channel_that_stands_still_has_the_largest_of_it():
    nothing = pd.DataFrame(
        columns=["manoeuvre", "phase", "channel", "white_noise", "sigma", "per_sample"]
    )
    rounding = {(f"m{i}", "rest", "gyro_x"): 1e-4 * i for i in (2, 3, 1)}
    levels = NoiseLevels(effective_levels(nothing, rounding=rounding))
    assert levels.of("m1", "rest", ["gyro_x"])[0] == pytest.approx(1e-4)
    assert levels.of("m1", "steady", ["gyro_x"])[0] == pytest.approx(3e-4)
