"""The size of the horizontal earth rate is known where its direction is not."""

import numpy as np
import pytest
from inference.walking import EARTH, LEVEL, NOISE, REST, TILT, campaign

from inertial.estimation import horizontal_earth_rate
from inertial.estimation.gyroscopes import joint


def test_a_determined_azimuth_is_constrained_and_the_bias_gains(monkeypatch):
    runs = [campaign(seed) for seed in range(40, 52)]
    fits = [joint(run.stills, run.turns, [], EARTH, TILT) for run in runs]
    levels = dict(zip(fits[0].names, fits[0].values, strict=True))
    names = {name for kind, name in levels if kind == "level 0"}
    assert len(names) == 12
    for name in names:
        size = np.hypot(levels["level 0", name], levels["level 1", name])
        assert size == pytest.approx(LEVEL, rel=1e-3)
    pulls = [
        (fit.values[9:12] - run.bias) / fit.sigma[9:12] for fit, run in zip(fits, runs, strict=True)
    ]
    assert 0.7 < np.std(pulls) < 1.35
    # Each azimuth is fitted: chi-squared has the mean of its degrees, within its own scatter.
    excess = [fit.chi_squared - fit.degrees for fit in fits]
    assert abs(np.mean(excess)) < 4 * np.sqrt(2 * fits[0].degrees / len(fits))
    monkeypatch.setattr(horizontal_earth_rate, "MAX_AZIMUTH_SIGMA", 0.0)
    without = joint(runs[0].stills, runs[0].turns, [], EARTH, TILT)
    assert fits[0].sigma[9:12].max() < 0.9 * without.sigma[9:12].min()


def test_a_poorly_determined_azimuth_keeps_both_components():
    sigma = {("level 0", "poor"): 0.3 * LEVEL, ("level 1", "poor"): NOISE / np.sqrt(REST)}
    sigma |= {("level 0", "good"): 0.1 * LEVEL, ("level 1", "good"): 0.1 * LEVEL}
    assert horizontal_earth_rate.known_azimuths(sigma, EARTH) == {"good"}
