"""Windows, epochs and the table's time and angle, by arrays whose truth is known."""

import numpy as np
import pytest

from inertial.estimation.angle_windows import (
    at_set_rate,
    by_angles,
    edges_of,
    noise_of,
    scale_and_bias,
)
from inertial.estimation.time_angle import (
    Errors,
    plateau,
    ripple_window,
    spin_down,
    spin_up,
    time_angle,
)
from inertial.physics.motion import Profile
from stages.studies.epochs import Formula, in_epochs, spread

STEP = 0.01
RATE, ACCELERATION = np.radians(10), np.radians(5)
PROFILE = Profile(2 * np.pi, RATE, ACCELERATION)
EDGES = STEP * np.arange(round(PROFILE.seconds / STEP) + 101)  # half a second of rest on each side
ANGLE, _ = PROFILE.at(EDGES - 0.5)
DENSITY = 3.5e-6  # rad/√s
EXACT = Errors(density=DENSITY, offset=0.0, whole=0.0)


# ---- windows


def test_a_window_of_n_samples_has_n_steps_and_not_one_more():
    true, bias, earth, n = 6e-4, 1e-6, 3.7e-5, 1800
    gyro = STEP * np.array([(1 + true) * way * RATE + bias + earth for way in (1, -1)])
    forward, backward = (edges_of(np.full(2500, one)) for one in gyro)
    window = at_set_rate(np.arange(0, 700, 100), n, STEP, RATE)
    scale, offset = scale_and_bias(window, forward, backward, earth)
    np.testing.assert_allclose(scale, true, atol=1e-12)
    np.testing.assert_allclose(offset, bias, atol=1e-12)
    np.testing.assert_allclose(window.forward, np.pi, rtol=1e-12)
    # S0's windows: 1801 samples against the angle of 1800 (design study, T11).
    wrong = at_set_rate(np.zeros(1, int), n + 1, STEP, RATE * n / (n + 1))
    assert (1 + scale_and_bias(wrong, forward, backward, earth)[0][0]) / (
        1 + true
    ) - 1 == pytest.approx(1 / n)


def test_the_noise_of_windows_is_that_of_many_windows():
    random = np.random.default_rng(1)
    window = at_set_rate(np.array([0]), 500, STEP, RATE)
    sigma, offset = noise_of(window, (DENSITY, 2 * DENSITY), 1e-6)
    found = []
    for _ in range(3000):
        sums = [
            edges_of(way * RATE * STEP + random.normal(0, size * STEP**0.5, 500))
            for way, size in ((1, DENSITY), (-1, 2 * DENSITY))
        ]
        for one in sums:
            one[-1] += random.normal(0, 1e-6)
        found.append([float(part[0]) for part in scale_and_bias(window, *sums, 0.0)])
    scatter = np.std(found, axis=0)
    np.testing.assert_allclose(scatter, [sigma[0], offset[0]], rtol=0.06)


def test_what_a_ripple_leaves_is_nothing_over_whole_periods():
    seconds = np.array([18.0, 18.01, 18.025])
    left = ripple_window(0.01, 20.0, seconds)
    assert left[0] < 1e-15 and left[2] == pytest.approx(0.01 / (20 * np.pi) / np.sqrt(2))
    start = np.random.default_rng(2).uniform(0, 1, 20_000)
    angle = np.cos(40 * np.pi * start) - np.cos(40 * np.pi * (start + 18.01))
    assert left[1] == pytest.approx(np.std(0.01 / (40 * np.pi) * angle), rel=0.02)


# ---- time and angle


def noisy(random: np.random.Generator, scale: float = 6e-4):
    """The turn by a gyro with a scale factor error and white noise."""
    white = random.normal(0, DENSITY * STEP**0.5, len(EDGES) - 1)
    return time_angle((1 + scale) * np.diff(ANGLE) + white, STEP, PROFILE.angle, EXACT)


def test_the_angle_is_tied_at_both_ends_and_a_brownian_bridge_between():
    random = np.random.default_rng(3)
    turns = [noisy(random) for _ in range(400)]
    off = np.array([turn.angle - ANGLE for turn in turns])
    sigma = turns[0].sigma
    assert sigma[0] == sigma[-1] == 0 and np.abs(off[:, -1]).max() < 1e-12
    inside = slice(300, -300, 100)
    np.testing.assert_allclose(off.std(axis=0)[inside], sigma[inside], rtol=0.15)
    time = EDGES[inside]
    bridge = DENSITY * np.sqrt(time * (EDGES[-1] - time) / EDGES[-1])
    np.testing.assert_allclose(sigma[inside], bridge, rtol=0.05)
    # Between two edges, it is that of the difference.
    i, j = 1000, 2800
    assert (off[:, j] - off[:, i]).std() == pytest.approx(float(turns[0].between(i, j)), rel=0.12)


def test_speed_and_ramps_come_back_within_their_sigma():
    random = np.random.default_rng(4)
    first, after = 260, len(EDGES) - 1 - 260
    pulls = []
    for _ in range(100):
        turn = noisy(random)
        speed = plateau(turn, first, after)
        up, down = spin_up(turn, first, speed), spin_down(turn, after, speed)
        pulls.append(
            [
                (speed.value - RATE) / speed.sigma,
                *((ramp.seconds.value - 2) / ramp.seconds.sigma for ramp in (up, down)),
                (up.acceleration.value - ACCELERATION) / up.acceleration.sigma,
                (up.start.value - 0.5) / up.start.sigma,
                (down.start.value - (0.5 + PROFILE.seconds - 2)) / down.start.sigma,
            ]
        )
    rms = np.sqrt(np.mean(np.square(pulls), axis=0))
    assert np.abs(np.mean(pulls, axis=0)).max() < 0.4  # of 100
    assert rms[0] == pytest.approx(1, abs=0.25)
    # The sigmas of ramps add up what partly cancels: never too small, and not idle.
    assert (rms[1:] < 1.2).all() and (rms[1:] > 0.1).all()


def test_a_smooth_ramp_is_as_long_as_one_of_constant_acceleration_with_its_spread():
    """The acceleration is a half sine of 3 s, whose variance is (1/4 − 2/π²) · 9 s²."""
    time = STEP * np.arange(2001)
    share = np.clip((time - 1) / 3, 0, 1)
    rate = RATE * np.sin(np.pi * share / 2) ** 2
    angle = np.append(0, np.cumsum((rate[1:] + rate[:-1]) / 2 * STEP))
    turn = time_angle(np.diff(angle), STEP, float(angle[-1]), EXACT)
    found = spin_up(turn, 800, plateau(turn, 800, 2000))
    assert found.seconds.value == pytest.approx(3 * np.sqrt(12 * (0.25 - 2 / np.pi**2)), rel=1e-3)
    assert found.start.value + found.seconds.value / 2 == pytest.approx(2.5, abs=1e-3)


def test_the_own_angle_gives_the_whole_turn_again():
    random = np.random.default_rng(5)
    forward, backward = (
        (1 + 6e-4) * way * np.diff(ANGLE) + random.normal(0, DENSITY * 0.1, len(EDGES) - 1)
        for way in (1, -1)
    )
    one = time_angle(forward, STEP, 2 * np.pi, EXACT)
    other = time_angle(-backward, STEP, 2 * np.pi, EXACT)
    window = at_set_rate(np.arange(300, 1500, 50), 1800, STEP, RATE)
    own = by_angles(window, one.angle, -other.angle)
    scale, _ = scale_and_bias(own, edges_of(forward), edges_of(backward), 0.0)
    whole = (forward.sum() - backward.sum()) / (4 * np.pi) - 1
    np.testing.assert_allclose(scale, whole, atol=1e-8)


# ---- epochs


def test_epochs_of_white_noise_have_the_variance_of_white_noise():
    random = np.random.default_rng(6)
    density, step = np.array([1.0, 2.0]), 0.01
    readings = random.normal(0, density / step**0.5, (20_000, 2))
    formula = Formula(np.array([[0.5, -0.5], [1.0, 0.0]]), np.array([0.0, 3.0]))
    assert formula.sigma(density, 1.0) == pytest.approx([np.sqrt(5) / 2, 1])
    for one in spread(formula, readings, [1, 10, 100]):
        assert one.epochs == 20_000 // one.samples
        expected = formula.sigma(density, one.samples * step) ** 2
        assert one.single == pytest.approx(expected, rel=5 * np.sqrt(2 / one.epochs))
        assert (one.running < one.single).all()


def test_a_masked_sample_is_none_of_its_epoch():
    readings = np.arange(12.0).reshape(6, 2)
    readings[1, 0] = np.nan
    single, running = in_epochs(readings, 2)
    assert single[:, 0].tolist() == [0.0, 5.0, 9.0]
    assert running[:, 1].tolist() == [2.0, 4.0, 6.0] and running[-1, 0] == pytest.approx(28 / 5)
