"""The forward model against the simulated laboratory, which shares no code with it."""

import chain
import numpy as np
import pandas as pd
import pytest
from in_memory import MemoryStream

from inertial.tables import CHANNELS, SAMPLES
from tests.test_closure import truth_of

COUNTS = {"accel": 0.05 / 2**15 / 0.01, "gyro": 0.1 / (3600 * 256) / 0.01}  # m/s², rad/s


@pytest.fixture(scope="module")
def quiet(tmp_path_factory) -> chain.Results:
    """A short campaign without noise, tilts, effects and faults."""
    document = chain.short(noise={name: 0 for name in chain.demo()["noise"]})
    document["campaign"]["table"]["position_sigma_arcsec"] = 0
    folder = tmp_path_factory.mktemp("quiet")
    campaign = chain.simulate(document, folder / "quiet")
    return chain.run(campaign, folder / "derived", "simulation", chain.BESIDE)


def test_noise_free_logs_are_met_to_a_count(quiet):
    # With the true parameters: those of the fit rest on the rounding, which is all the noise here.
    true = {
        f"{stage}_parameters": quiet[f"{stage}/parameters"].assign(
            value=lambda table, stage=stage: table["parameter"].map(truth_of(stage))
        )
        for stage in ("accelerometer", "gyroscope")
    }
    simulated = chain.again(quiet, "simulation", **true)["simulated"]
    turns = simulated[simulated["phase"].isin(["spin-up", "steady", "spin-down"])]
    assert turns["manoeuvre"].nunique() == 6
    for channel in CHANNELS:
        counts = turns[f"residual_{channel}"] / COUNTS[channel[:-2]]
        # An increment is a difference of two rounded sums, so one count is the least there is.
        assert counts.abs().max() < 1.01, channel
        sums = counts.groupby(turns["manoeuvre"]).cumsum()
        assert sums.abs().max() < 3, channel  # nor is a sum off by more, but for the tilts


def test_every_sample_of_a_turn_is_there_once_with_the_time_of_its_log(quiet):
    simulated = quiet["simulation/simulated"]
    turns = simulated[simulated["manoeuvre"].str.endswith("ward")]
    assert turns["manoeuvre"].nunique() == 6
    assert not turns.duplicated(["log", "record"]).any()  # the rests beside them are in these
    samples = quiet["decode/samples"].set_index(["log", "record"])["time"]
    at = pd.MultiIndex.from_frame(turns[["log", "record"]])
    np.testing.assert_allclose(turns["time"], samples.loc[at], atol=1e-9)


def test_the_blocks_of_a_rest_have_the_time_of_their_log(quiet):
    """Each log counts from its own first sample, half a minute after the end of the one before."""
    clocks = quiet["decode/clocks"]
    began = 90.0 * np.arange(len(clocks))
    own = clocks.assign(clock="own", began=began, from_s=0.0, to_s=60.0)
    simulated = chain.again(quiet, "simulation", clocks=own)["simulated"]
    rests, blocks = (
        table[table["manoeuvre"] == "y-up"].set_index("record" if i else "from_record")["time"]
        for i, table in enumerate((quiet["segment/blocks"], simulated))
    )
    assert len(rests) >= 2
    np.testing.assert_allclose(blocks.loc[rests.index], rests, atol=1e-9)


def test_a_counter_that_begins_again_in_a_turn_moves_no_table(quiet):
    """The rates before and after are what they were: only the stamps go back, by 2³² µs."""
    samples = quiet["decode/samples"].copy()
    own = np.flatnonzero(samples["log"] == "z-forward.asc")
    samples.loc[own[len(own) // 2 :], "time"] -= 4294.967296
    stream = MemoryStream(SAMPLES.arrow(samples))
    wrapped = chain.again(quiet, "simulation", samples=stream)
    before, after = (
        table.query("manoeuvre == 'z-forward'")[[f"residual_{name}" for name in CHANNELS]]
        for table in (quiet["simulation/simulated"], wrapped["simulated"])
    )
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_on_clean_data_the_residuals_are_the_noise(clean):
    fidelity = clean[0]["simulation/fidelity"]
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
    # The turn with the gap is simulated with it: 12 s on, the table is where it should be.
    assert ratio["z-backward", "trapezoid", "gyro_x"] > 100
    assert ratio["z-backward", "trapezoid", "accel_z"] == pytest.approx(1, abs=0.1)


@pytest.fixture(scope="module")
def lossy(tmp_path_factory) -> chain.Results:
    """As `quiet`, with S0's gap in one turn and shorter rests."""
    lost = {"log": "z-backward.asc", "line": 2193, "samples": 1197}
    noise = {name: 0 for name in chain.demo()["noise"]}
    document = chain.demo(noise=noise, faults=[{"lose": lost}])
    document["campaign"]["table"]["position_sigma_arcsec"] = 0
    for entry in document["campaign"]["plan"]:
        entry |= {"seconds": 60} if entry["do"] == "rest" else {}
    folder = tmp_path_factory.mktemp("lossy")
    campaign = chain.simulate(document, folder / "lossy")
    return chain.run(campaign, folder / "derived", "simulation", chain.BESIDE)


@pytest.mark.slow
def test_a_turn_with_a_gap_is_met_to_a_count_on_both_sides_of_it(lossy):
    simulated = lossy["simulation/simulated"]
    moving = simulated["phase"].isin(["spin-up", "steady", "spin-down"])
    turn = simulated[moving & (simulated["manoeuvre"] == "z-backward")]
    assert turn["time"].diff().max() == pytest.approx(11.98)
    for channel in CHANNELS:
        counts = turn[f"residual_{channel}"] / COUNTS[channel[:-2]]
        assert counts.abs().max() < 1.01, channel


@pytest.mark.slow
def test_what_is_masked_in_a_turn_is_not_compared(lossy):
    spikes = [1105, 2000, 2001, 3000]
    rows = [
        {"log": "x-forward.asc", "from_record": record, "to_record": record + 1,
         "finding": "spike", "sensor": None, "axis": None, "repeated": False, "censored": False}
        for record in spikes
    ]  # fmt: skip
    tables = chain.again(lossy, "segment", masks=pd.DataFrame(rows))
    changed = {name: tables[name] for name in ("blocks", "performed", "segments")}
    simulated = chain.again(lossy, "simulation", **changed)["simulated"]
    turn = simulated[simulated["manoeuvre"] == "x-forward"].set_index("record")
    assert turn.loc[spikes, "residual_gyro_x"].isna().all()
    others = turn.drop(spikes)["residual_gyro_x"] / COUNTS["gyro"]
    assert others.abs().max() < 1.01


def test_a_turn_at_another_rate_than_stated_is_met_at_the_rate_that_it_had():
    """At half its rate, through its angle: what is left of its readings is noise, and no line."""
    stated = {"y-backward": {"rate_deg_s": 120.0}}
    results = chain.in_memory_of(chain.short(misstated={"plan": stated}), "criticism")
    simulated = results["simulation/simulated"]
    steady = simulated[simulated["phase"] == "steady"].groupby("manoeuvre")
    rms = steady["residual_gyro_y"].apply(lambda residual: np.sqrt(np.mean(residual**2)))
    assert rms["y-backward"] == pytest.approx(rms["y-forward"], rel=0.3)
    causes = {*results["criticism/findings"]["cause"]}
    assert not causes & {"oscillation", "table_ripple", "table_eccentricity"}
