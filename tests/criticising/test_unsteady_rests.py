"""A slow oscillation at rest has the spectrum of a random walk, and is none of a sensor."""

from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace

import chain
import numpy as np
import pandas as pd
import pytest

from stages.criticism.drift_at_rest import unsteady_rests

pytestmark = pytest.mark.slow

PER_COUNT = 1 / 6553.6  # m/s²
MILLI_G = 9.80665e-3


def criticised(folder: Path, hertz: float, size: float, walk: float = 0.0) -> chain.Results:
    """Rests of a minute and turns in one log of 100 Hz, with an oscillation of `size`, m/s².

    `walk`: random walk of the accelerometers, m/s²/√h.
    """
    document = deepcopy(chain.short(seed=5))
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["noise"]["accelerometer_random_walk_m_s2_sqrt_h"] = walk
    document["noise"]["velocity_random_walk_m_s_sqrt_h"] = 0.07 if walk else 0.0064
    document["campaign"]["instrument"] = {"name": "made up", "rate_hz": 100}
    document["handling"]["change_s"] = 10
    for each in document["campaign"]["plan"]:
        each |= {"log": "all.csv"} | ({"seconds": 60} if each["do"] == "rest" else {})
    log = chain.simulate(document, folder / "raw") / "all.csv"
    table = pd.read_csv(log)
    for i, (axis, part) in enumerate(zip("xyz", (1, 0.8, 1.2), strict=True)):
        wave = part * np.sin(2 * np.pi * hertz * table["time"] + i)
        table[f"accel_{axis}"] += size / PER_COUNT * wave
    table.to_csv(log, index=False)
    return chain.run(folder / "raw", folder / "derived", "diagnosis", chain.BESIDE)


@pytest.mark.parametrize(("hertz", "size"), [(0.05, 7 * MILLI_G), (0.2, MILLI_G)])
def test_it_is_a_cause_that_says_what_it_may_be(tmp_path, hertz, size):
    """It was "usable, no fault was detected", with biases to 5 mg."""
    made = criticised(tmp_path, hertz, size)
    causes = made["diagnosis/causes"].set_index("cause")
    assert "no drift of a sensor" in causes.loc["accel_random_walk", "sentence"]
    verdicts = made["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "usable" and verdicts["accel"] != "usable"


def test_the_random_walk_of_a_poor_sensor_is_a_term_of_its_noise(tmp_path):
    """5 mg/√h: 0.65 mg within a minute, and samples scatter by 1.2 mg."""
    made = criticised(tmp_path, 1.0, 0.0, walk=5 * MILLI_G)
    assert not made["criticism/findings"]["sentence"].str.contains("no drift of a sensor").any()
    assert made["diagnosis/verdict"]["verdict"].isin(["usable", "usable_within_limits"]).all()


@pytest.mark.parametrize(("size", "told"), [(1e-3, True), (1e-4, False)])
def test_a_vibration_that_begins_after_the_first_rest_is_no_drift_of_a_sensor(size, told):
    """Of 0.2 Hz as it is sampled: each mean of 5 s holds a whole period, and no walk is in a rest.

    `size`: its amplitude, rad/s; readings scatter by 3.5e-4 rad/s.
    """
    random = np.random.default_rng(1)
    quiet = 3.5e-4 * random.standard_normal(12000)
    shaken = quiet + size * np.sin(2 * np.pi * 0.2 * np.arange(12000) / 100)
    scatter = {"first": quiet.std(), "second": shaken.std()}
    rows = []
    for n in np.unique(np.geomspace(1, 3000, 30).astype(int)):
        variance = [np.square(np.diff(means_of(one, n))).mean() / 2 for one in (quiet, shaken)]
        deviation = float(np.sqrt(np.mean(variance)))
        rows += [{"channel": f"gyro_{axis}", "tau": n / 100, "lower": deviation} for axis in "xyz"]
    rests = [
        SimpleNamespace(manoeuvre=SimpleNamespace(name=name), seconds=np.full(24, 5.0))
        for name in scatter
    ]
    noise = SimpleNamespace(
        of_samples=lambda name, *_: np.full(3, scatter[name]), rounded=lambda _: 0
    )
    data = SimpleNamespace(gyro_positions=(rests, []), noise=noise)
    found = unsteady_rests(data, "gyro", np.zeros(3), pd.DataFrame(rows))
    assert bool(found) == told
    if found:
        assert 1.5 < found.seconds < 3.5 and found.scatter == scatter["first"]


def means_of(readings: np.ndarray, count: int) -> np.ndarray:
    """Means of as many readings, one after another."""
    return readings[: len(readings) // count * count].reshape(-1, count).mean(axis=1)
