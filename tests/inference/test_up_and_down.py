"""Two positions with tilt: within the stated sigma, whatever the tilt is."""

import numpy as np
import pytest

from inertial.estimation.accelerometer_formulas import Upright, up_and_down

G = 9.7936
NOISE = 1e-5  # m/s²


def drawn(random: np.random.Generator, tilt: float) -> tuple[float, float]:
    """The errors of bias and scale factor in units of their sigmas."""
    bias, scale = random.normal(0, 0.02), random.normal(0, 1e-3)
    cross = random.normal(0, 0.01, 2)
    rests = []
    for up in (1.0, -1.0):
        lean = random.normal(0, tilt, 2)
        along = np.cos(np.linalg.norm(lean))
        mean = bias + G * up * ((1 + scale) * along + cross @ lean) + random.normal(0, NOISE)
        rests.append(Upright(up, mean, NOISE))
    found = up_and_down(rests, G, 0.0, tilt)
    return (found.bias - bias) / found.bias_sigma, (found.scale - scale) / found.scale_sigma


@pytest.mark.parametrize("degrees", [0.0, 0.01, 0.1, 1.0])
def test_the_truth_comes_back_within_the_stated_sigma(degrees):
    random = np.random.default_rng(2)
    pulls = np.array([drawn(random, np.radians(degrees)) for _ in range(400)])
    # 400 pulls: means to 0.05, deviations to 4 %, and the sigma is a little too large, not small.
    assert np.abs(pulls.mean(axis=0)).max() < 0.2
    assert (pulls.std(axis=0) > 0.75).all() and (pulls.std(axis=0) < 1.12).all()


def test_a_degree_of_tilt_shortens_by_its_square():
    lean = np.radians(1.0)
    rests = [Upright(up, up * G * np.cos(lean), NOISE) for up in (1.0, -1.0)]
    found = up_and_down(rests, G, 0.0, 0.0)
    assert found.bias == pytest.approx(0, abs=1e-12)
    assert found.scale == pytest.approx(-152.3e-6, rel=1e-3)  # cos 1° − 1
    allowed = up_and_down(rests, G, 0.0, lean)
    assert abs(allowed.scale) < 2 * allowed.scale_sigma
    assert up_and_down(rests[:1], G, 0.0, lean) is None
