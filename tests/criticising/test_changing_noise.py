"""Noise that grows for a while, or with the rate or the frequency: there is nothing to find."""

from dataclasses import replace

import chain
import numpy as np
import pytest
from hidden import hidden_plans

import laboratory
from inertial.campaign.records import Part
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_observations import Position, RateSegment, StaticRate
from inertial.estimation.spectrum import level_of_pieces, white_level
from inertial.estimation.turning_noise import with_turning_noise

COUNTS = np.array([6553.6] * 3 + [92160.0] * 3)  # of a reading of 1 m/s², or 1 rad/s, at 100 Hz
SAMPLES = np.array([5.4e-3] * 3 + [1.9e-4] * 3)  # about the noise of one, m/s² and rad/s


def louder(recording: laboratory.Recording, start: float, end: float, times: float, seed: int):
    """Readings with more white noise for a while, s; what one leaves over is in the next."""
    random = np.random.default_rng(seed)
    logs = {}
    for log, records in recording.records.items():
        time = (records.stamps - recording.start) / 1e9
        within = ((time >= start) & (time < end))[:, None]
        more = random.standard_normal(records.counts.shape) * times * SAMPLES * COUNTS * within
        carried = np.diff(np.rint(np.cumsum(more, axis=0)), axis=0, prepend=0)
        logs[log] = replace(records, counts=(records.counts + carried).astype(records.counts.dtype))
    return replace(recording, records=logs)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("plan", "start", "end", "times"),
    [
        # It begins 2 s before a rest of 300 s ends, where a window of the spectrum is next to zero.
        ("positions", 1378.0, 2600.0, 3.0),
        # And while the table slows down after a turn.
        ("rates", 690.0, 1410.0, 3.0),
        ("positions", 1712.0, 2405.0, 17.0),
    ],
)
def test_nothing_is_found(plan, start, end, times):
    """Once a bias jump at 9 to 40 sigma, a shift in the fixture, a random walk."""
    recording = laboratory.perform(laboratory.specify(hidden_plans.PLANS[plan](seed=4002)))
    tables = chain.in_memory(louder(recording, start, end, times, 5), "criticism", chain.BESIDE)
    assert tables["criticism/findings"].empty


@pytest.mark.slow
def test_noise_of_a_scale_factor_is_no_effect() -> None:
    """It adds up in the angle of a turn: two effects of the gyros and two false turns, once."""
    effects = {"gyro_rate_noise": {"relative_ppm_sqrt_s": [200, 200, 200]}}
    document = hidden_plans.PLANS["rates"](seed=7, effects=effects)
    tables = chain.in_memory_of(document, "criticism", chain.BESIDE)
    assert not tables["criticism/findings"]["verdict"].isin(["found", "one_of_class"]).any()


@pytest.mark.slow
@pytest.mark.parametrize("arcseconds", [0.9, 9.0])
def test_white_noise_of_the_angle_is_quantisation(arcseconds: float) -> None:
    """The dither of a ring laser leaves it; once blocks of turns were off by 2.4 times their noise.

    It is free of the white noise of the rate, which stays as it is, and no effect.
    """
    quiet, noisy = (
        chain.in_memory_of(hidden_plans.PLANS["rates"](seed=7, effects=effects), to, chain.BESIDE)
        for effects, to in (
            ({}, "noise"),
            ({"gyro_angle_noise": {"q_arcsec": arcseconds}}, "criticism"),
        )
    )
    assert noisy["criticism/findings"].empty
    (fit,) = noisy["gyroscope/fit"].query("method == 'joint'").to_dict("records")
    assert fit["chi_squared"] / fit["degrees"] == pytest.approx(1, abs=0.1)
    without, found = (
        each["noise/levels"].query("channel == 'gyro_x' and manoeuvre.isna()").iloc[0]
        for each in (quiet, noisy)
    )
    assert np.degrees(found["quantisation"]) * 3600 == pytest.approx(arcseconds, rel=0.02)
    assert not without["quantisation"] > 1e-7  # rad, a count
    assert found["white_noise"] == pytest.approx(without["white_noise"], rel=0.15)


@pytest.mark.parametrize("of_gyros", [True, False])
def test_angles_that_scatter_show_whose_the_noise_in_motion_is(of_gyros: bool) -> None:
    """Six pairs of turns about x, y, z: their sums differ by the noise at rest, or by thrice it."""
    random = np.random.default_rng(11)
    quiet, moving, seconds, blocks = 1e-5, 3e-5, 40.0, 200
    turns, rests = list[RateSegment](), list[StaticRate]()
    for number in range(6):
        axis, up = np.eye(3)[number % 3], 1 - 2 * (number // 3)
        place = Position(f"{number}", up * axis)
        rests.append(StaticRate(place, np.zeros(3), np.full(3, quiet / 10), axis))
        for sense in (1, -1):
            angle = sense * up * 2 * np.pi
            drawn = random.normal(size=(blocks, 3)) * moving * np.sqrt(seconds / blocks)
            if not of_gyros:  # jitter of a table that ends where it should
                drawn += random.normal(size=3) * quiet * np.sqrt(seconds) / blocks - drawn.mean(0)
            sums = 1.003 * angle * up * axis / blocks + drawn
            each = np.full(blocks, seconds / blocks)
            levels = np.full(3, moving), np.full(3, quiet)
            turns.append(RateSegment(place, up * axis, angle, 1e-6, sums, each, *levels))
    found = with_turning_noise(turns, rests)
    expected = moving if of_gyros else quiet
    assert all(turn.quiet_density == pytest.approx(expected) for turn in found)


def test_the_level_of_pieces_of_unlike_noise_is_that_of_their_mean_power():
    random = np.random.default_rng(2)
    quiet, loud = (random.exponential(size, (40, 400)) for size in (1.0, 400.0))
    alike, _ = level_of_pieces([quiet[:20], quiet[20:]], [3.0, 3.0])
    np.testing.assert_array_equal(alike, white_level(quiet)[0])
    level, sigma = level_of_pieces([quiet, loud], [6.0, 3.0])
    expected = np.sqrt((6 * 1.0 + 3 * 400.0) / 9)
    assert level.mean() == pytest.approx(expected, rel=0.02)
    # These bins are independent; a Hann window leaves one in 1.5.
    assert level.std() == pytest.approx(sigma.mean() / 1.5**0.5, rel=0.2)


def position(means: np.ndarray) -> StaticPosition:
    """A rest of blocks of 5 s with a level of 1 per √s in each channel."""
    ones, five = np.ones(len(means)), np.full(len(means), 5.0)
    up = np.array([0.0, 0.0, 1.0])
    part = Part("rest", "rest")
    return StaticPosition(
        part, None, up, up, 0.0, means, 500 * ones, five, five.cumsum(), ones, np.ones(3)
    )


def test_the_sigma_of_a_mean_is_that_of_the_noise_which_its_blocks_have():
    random = np.random.default_rng(3)
    quiet = random.standard_normal((2000, 6, 3)) / np.sqrt(5)
    stated = np.array([position(each).over()[1] for each in quiet])
    assert np.mean(stated == 30**-0.5) > 0.999  # white noise keeps its level
    first = random.integers(5, size=2000)[:, None]
    loud = quiet * np.where((np.arange(6) - first) // 2 == 0, 10.0, 1.0)[:, :, None]
    off = np.array([np.divide(*position(each).over()) for each in loud])
    # Four differences tell it, so it is no Gaussian. With the level of the whole 0.73 are beyond 2.
    assert np.mean(np.abs(off) > 2) < 0.2
    assert np.median(np.abs(off)) == pytest.approx(0.67, abs=0.25)


@pytest.mark.parametrize("course", ["ramp", "warm-up", "jump"])
def test_a_drift_or_a_jump_of_the_bias_is_no_noise(course):
    block = np.arange(6.0)[:, None]
    drift = {"ramp": 3 * block, "warm-up": 6 * np.exp(-block / 6), "jump": 2.0 * (block > 2)}
    random = np.random.default_rng(4)
    quiet = random.standard_normal((500, 6, 3)) / np.sqrt(5)
    sigmas = np.array([position(each + drift[course]).over()[1] for each in quiet])
    assert np.mean(sigmas == 30**-0.5) > 0.8


@pytest.mark.parametrize("returns", [0, 5])
def test_a_large_jump_does_not_hide_as_noise_of_a_piece(returns):
    """Pieces of 30 s were taken for 4 to 6 times louder, and a pulse of 20 sigma was in nothing."""
    random = np.random.default_rng(5)
    block, first = np.arange(24)[None, :, None], random.integers(2, 17, 200)[:, None, None]
    there = (block >= first) & ((block < first + returns) | (returns == 0))
    jump = 20 / np.sqrt(5) * there * np.array([0, 1, 0])  # of one axis
    quiet = random.standard_normal((200, 24, 3)) / np.sqrt(5)
    sigmas = np.array([[p.over()[1] for p in position(each).pieces(30)] for each in quiet + jump])
    assert np.mean(sigmas == 30**-0.5) > 0.9


def test_a_part_of_a_rest_that_is_louder_is_heard_in_its_piece():
    random = np.random.default_rng(6)
    loud = random.standard_normal((500, 24, 3)) / np.sqrt(5)
    loud[:, 6:12] *= 5.0
    sigmas = np.array([[p.over()[1] for p in position(each).pieces(30)] for each in loud])
    expected = np.array([1, 5, 1, 1]) / np.sqrt(30)
    assert np.median(sigmas, axis=0) == pytest.approx(np.tile(expected, (3, 1)).T, rel=0.3)
