"""Drawn faults are as large as they say, by what the laboratory records."""

import cases
import numpy as np
import pytest
from campaigns import performed
from diagnosis_draws import names, places
from diagnosis_faults import BY_NAME, Setting, Told

BIAS = {"accel": 2e-5, "gyro": 2e-8}  # m/s², rad/s: sigmas of a result, as made up
SIGMAS = {
    sensor: {f"bias_{axis}": bias for axis in "xyz"} | {f"scale_{axis}": 5e-6 for axis in "xyz"}
    for sensor, bias in BIAS.items()
}
RESTS = 6
SIGMA = 20.0


@pytest.fixture(scope="module")
def document():
    return cases.positions(seed=5)


@pytest.fixture(scope="module")
def clean(document):
    return performed(document)


def told(document, name: str, seed: int, sigma: float = SIGMA) -> Told:
    setting = Setting(document, places("positions"), SIGMAS)
    return BY_NAME[name].hide(setting, np.random.default_rng(seed), sigma)


def moved(document, clean, hidden: Told):
    """By how much the mean readings of every log move, (logs, 6), m/s² and rad/s."""
    spoiled = performed(cases.merged(document, hidden.changes))
    return np.array(
        [
            (after.counts.mean(axis=0) - before.counts.mean(axis=0)) * before.units
            for before, after in zip(clean.records.values(), spoiled.records.values(), strict=True)
        ]
    )


@pytest.mark.parametrize("seed", [1, 2, 4])
def test_spikes_move_a_bias_by_so_many_sigma(document, clean, seed):
    """The bias is a sixth of what one of six rests is off; 30 spikes in whole counts."""
    hidden = told(document, "spikes", seed)
    means = moved(document, clean, hidden)
    (log,), channels = np.flatnonzero(means.any(axis=1)), np.flatnonzero(means.any(axis=0))
    sensor = hidden.cause.sensor
    assert channels.tolist() == ["xyz".index(hidden.cause.axis) + 3 * (sensor == "gyro")]
    by = means[log, channels[0]] / RESTS / BIAS[sensor]
    smallest = 30 / 30_000 * 20 * {"accel": 1.067e-3, "gyro": 3.49e-5}[sensor]
    assert by == pytest.approx(max(SIGMA, smallest / RESTS / BIAS[sensor]), rel=0.01)


def test_a_range_that_ends_within_the_scatter_moves_a_bias_by_so_many_sigma(document, clean):
    means = moved(document, clean, told(document, "clipping within the scatter", 3, 5))
    off = means[means != 0]
    assert off.size == 1
    scatter = 1.067e-3 / np.sqrt(30_000)  # of what is cut off at most
    assert -off[0] == pytest.approx(5 * RESTS * BIAS["accel"], abs=5 * scatter)


def test_a_position_that_is_off_moves_a_bias_by_so_many_sigma(document, clean):
    """One axis reads the force of the tilt, but for the 2″ by which each set position is off."""
    means = moved(document, clean, told(document, "position off", 3))
    (log,) = np.flatnonzero(np.abs(means).max(axis=1) > 1e-6)
    most = np.abs(means[log, :3]).max()
    error = 4 * np.radians(2 / 3600) * 9.79
    assert most == pytest.approx(SIGMA * RESTS * BIAS["accel"], abs=error)


def test_every_draw_has_a_name_of_its_own():
    every = list(names())
    assert len(every) == len(set(every))
    assert sum(name.startswith("clean|") for name in every) == 300
    assert sum(name.startswith("pair|") for name in every) == 60
