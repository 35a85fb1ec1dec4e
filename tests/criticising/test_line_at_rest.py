"""An oscillation that goes on while the table rests is removed from rests and ramps too."""

from dataclasses import replace
from types import SimpleNamespace

import chain
import numpy as np
import pandas as pd
import pytest
from residuals_of_turns import NOISE, turns

import laboratory
from inertial import tables
from inertial.signal.scatter import smallest_step
from stages.criticism.oscillation_removal import without_lines
from stages.criticism.oscillation_search import find_oscillations

HERTZ, SIZE, PHASE = 0.8, 1e-3, 0.7  # Hz, rad/s, rad
STEP, LONG, AT_REST = 0.01, 20, 500  # s, and samples of a block


def wave(time):
    return SIZE * np.sin(2 * np.pi * HERTZ * time + PHASE)


def blocks_of(name, phase, time, read, long):
    n = len(time) // long * long
    time, read = (values[:n].reshape(-1, long).mean(axis=1) for values in (time, read))
    own = {"manoeuvre": name, "phase": phase, "time": time, "count": long, "seconds": long * STEP}
    rates = dict.fromkeys(tables.GYRO, 0.0) | {"gyro_y": read}
    return pd.DataFrame(own | dict.fromkeys(tables.ACCEL, 0.0) | rates)


def test_nothing_of_it_is_left_in_any_block():
    """As the line is computed without noise, what is left is its own error, of the turns' noise."""
    made, blocks = [], []
    for number, turn in enumerate(turns(5)):
        start = 100.0 * number + 30.0
        time = start + STEP * np.arange(len(turn.truth))
        truth = turn.truth.copy()
        truth[:, 1] += wave(time)
        made.append(replace(turn, truth=truth, start=start, matrix=np.eye(3)))
        before = start - STEP * np.arange(1000, 0, -1)
        blocks += [
            blocks_of(turn.name, "rest-before", before[:500], wave(before[:500]), AT_REST),
            blocks_of(turn.name, "spin-up", before[500:], wave(before[500:]), LONG),
            blocks_of(turn.name, "steady", time, wave(time), LONG),
        ]
    resting = 5000.0 + STEP * np.arange(30_000)
    blocks.append(blocks_of("up", "rest", resting, wave(resting), 90))
    read = pd.concat(blocks, ignore_index=True)
    (line,) = find_oscillations(made, 1e-3, 2 * HERTZ / 3).oscillations
    plan = [SimpleNamespace(name="up", do="rest", tumbled=None)]

    def left(at_rest):
        quiet = without_lines(read, plan, made, [replace(line, at_rest=at_rest)])
        return quiet["gyro_y"].abs().groupby(quiet["phase"]).max()

    samples = min(len(turn.truth) for turn in made)
    error = NOISE * np.sqrt(2 / samples)  # of an amplitude, 1 sigma
    assert (left(True) < 12 * error).all()  # some seconds beyond the turn, twice as much
    assert (left(False)[["spin-up", "rest"]] > 100 * error).all()


@pytest.fixture(scope="module")
def decoded():
    document = chain.demo(seed=4)
    document["receiver"]["rate_hz"] = 50
    recording = laboratory.perform(laboratory.specify(document))
    return recording, chain.in_memory(recording, "decode")


def criticised(decoded, disturbance):
    """The findings where the rates, as functions of the samples, are added to the x gyro."""
    recording, tables_before = decoded
    samples = tables_before["decode/samples"].copy()
    count = smallest_step(samples["gyro_x"].to_numpy())
    samples["gyro_x"] += count * np.rint(disturbance(samples) / count)
    disturbed = tables_before.replaced("decode/samples", samples)
    results = chain.in_memory(recording, "criticism", chain.BESIDE, onto=disturbed)
    return results["criticism/findings"].set_index("cause"), results["criticism/effects"]


@pytest.mark.slow
def test_hum_that_the_sampling_folds_to_a_slow_line_is_no_structure(decoded):
    """50.45 Hz sampled at 50 Hz: from rest to rest it adds up to 15 arc seconds to a turn."""
    amplitude = np.radians(0.01)
    findings, effects = criticised(
        decoded, lambda samples: amplitude * np.sin(2 * np.pi * 50.45 * samples["time"])
    )
    assert set(findings.index) == {"oscillation"}
    assert "It goes on while the table rests" in findings.loc["oscillation", "sentence"]
    line = effects[effects["effect"] == "oscillation"].set_index("parameter")
    assert line.loc["frequency", "value"] == pytest.approx(0.45, abs=5e-4)
    assert line.loc["amplitude", "value"] == pytest.approx(amplitude, rel=0.02)


@pytest.mark.slow
def test_what_oscillates_while_the_table_turns_is_not_said_to_go_on(decoded):
    """From zero angle to zero angle of the case, as the table starts and stops."""

    def while_turning(samples):
        fast = np.abs(samples[["gyro_x", "gyro_y", "gyro_z"]]).max(axis=1) > np.radians(9.5)
        return np.where(fast, np.radians(0.01) * np.sin(2 * np.pi * 1.3 * samples["time"]), 0.0)

    findings, _ = criticised(decoded, while_turning)
    assert set(findings.index) == {"oscillation"}
    assert "at rest" not in findings.loc["oscillation", "sentence"]
    assert "goes on" not in findings.loc["oscillation", "sentence"]
