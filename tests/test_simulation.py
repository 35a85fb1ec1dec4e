"""The forward model against the simulated laboratory, which shares no code with it."""

import chain
import numpy as np
import pytest

from stages.contracts.tables import CHANNELS

COUNTS = {"accel": 0.05 / 2**15 / 0.01, "gyro": 0.1 / (3600 * 256) / 0.01}  # m/s², rad/s


@pytest.fixture(scope="module")
def quiet(tmp_path_factory) -> chain.Results:
    """The demo campaign without noise, tilts, effects and faults."""
    document = chain.demo(noise={name: 0 for name in chain.demo()["noise"]})
    document["campaign"]["table"]["position_sigma_arcsec"] = 0
    folder = tmp_path_factory.mktemp("quiet")
    campaign = chain.simulate(document, folder / "quiet")
    return chain.run(campaign, folder / "derived", "simulation")


def test_noise_free_logs_are_met_to_a_count(quiet):
    simulated = quiet["simulation/simulated"]
    turns = simulated[simulated["phase"].isin(["spin-up", "steady", "spin-down"])]
    assert turns["manoeuvre"].nunique() == 6
    for channel in CHANNELS:
        counts = turns[f"residual_{channel}"] / COUNTS[channel[:-2]]
        # An increment is a difference of two rounded sums, so one count is the least there is.
        assert counts.abs().max() < 1.01, channel
        sums = counts.groupby(turns["manoeuvre"]).cumsum()
        assert sums.abs().max() < 1.5, channel


def test_on_clean_data_the_residuals_are_the_noise(clean, tmp_path_factory):
    folder = tmp_path_factory.mktemp("simulated")
    campaign = chain.simulate(chain.demo(seed=21), folder / "campaign")
    fidelity = chain.run(campaign, folder / "derived", "simulation")["simulation/fidelity"]
    turns = fidelity[fidelity["profile"] == "trapezoid"]
    assert len(turns) == 6 * 6
    ratio = turns["residual_rms"] / turns["noise_rms"]
    # 5800 samples tell an rms to 1 %; quantisation adds 1 to 2 % to the accelerometers.
    np.testing.assert_allclose(ratio, 1.01, atol=0.06)


def test_the_demo_shows_what_its_simulation_lacks(demo_criticised):
    fidelity = demo_criticised["simulation/fidelity"].set_index(["manoeuvre", "profile", "channel"])
    ratio = fidelity["residual_rms"] / fidelity["noise_rms"]
    # 0.01 rad/s of oscillation over 3.5e-5 rad/s of noise, on the x gyro, in every turn.
    assert ratio["y-forward", "trapezoid", "gyro_x"] > 100
    assert ratio["y-forward", "trapezoid", "accel_x"] == pytest.approx(1, abs=0.1)
    assert ("z-backward", "trapezoid", "gyro_x") not in ratio  # incomplete, not simulated
