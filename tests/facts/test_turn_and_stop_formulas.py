"""S3, turn and stop: its own formulas close, and what they keep of the earth (T21, T22)."""

from dataclasses import replace

import numpy as np
import pytest

from inertial.estimation.accelerometer_formulas import pooled_positions, six_position_formula
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.gyroscope_formulas import pairs_of, turn_and_stop
from inertial.estimation.gyroscope_observations import Earth, Gap, Position, RateSegment, StaticRate
from inertial.physics.motion import Profile, level_axes, turned_all
from inertial.physics.site import earth_rate

DEGREE_PER_HOUR = np.radians(1 / 3600)
UP, LEVEL = earth_rate(np.radians(30.5278))
WUHAN = Earth(UP, 1e-12, LEVEL)
GRAVITY = 9.79361
SLOW = Profile(2 * np.pi, np.radians(6), np.radians(6))
FAST = Profile(2 * np.pi, np.radians(12), np.radians(12))
WINDOWS = {SLOW: 64.0, FAST: 36.0}  # s, what S3 cuts out for each turn
STEP, FINE = 0.1, 10  # s, blocks, and the pieces in which the earth is summed
WALK = np.radians(0.15) / 60  # rad/√s, STIM300
TILT, ANGLE = 1e-5, 1e-5  # rad
NO_LEAN = np.zeros(3)
NO_EARTH = Earth(0.0, 0.0, 0.0)  # none is taken out, so the bias by turns is D + M E


def azimuths(up: np.ndarray, azimuth: float) -> np.ndarray:
    """North in body axes."""
    first, second = level_axes(up)
    return np.cos(azimuth) * first + np.sin(azimuth) * second


def a_turn(
    up: np.ndarray,
    profile: Profile,
    sign: float,
    sensor: tuple[np.ndarray, np.ndarray],
    azimuth: float,
    random: np.random.Generator | None = None,
    lean: np.ndarray = NO_LEAN,
    known: bool = False,
) -> RateSegment:
    """A turn in the middle of S3's window, with exact physics but for the noise."""
    M, bias = sensor
    window = WINDOWS[profile]
    start = (window - profile.seconds) / 2
    edges = np.linspace(0, window, round(window / STEP) + 1)
    angle, _ = profile.at(edges - start)
    step = window / (len(edges) - 1)
    pieces = (np.arange(FINE * (len(edges) - 1)) + 0.5) * step / FINE
    # A backward turn unwinds the forward one: from 360° to 0.
    turned, _ = profile.at(pieces - start)
    now = turned if sign > 0 else 2 * np.pi - turned
    north = azimuths(up, azimuth)
    level = LEVEL * turned_all(north, up, now).reshape(-1, FINE, 3).mean(axis=1)
    truth = np.outer(sign * np.diff(angle), up + lean) + step * (level + UP * up)
    error = 0 if random is None else random.normal(0, ANGLE)
    truth += np.outer(np.full(len(truth), error / len(truth)), up)
    sums = truth @ M.T + step * bias
    if random is not None:
        sums += random.normal(0, WALK * np.sqrt(step), sums.shape)
    return RateSegment(
        Position(f"{up}", up, north=north if known else None),
        up,
        sign * 2 * np.pi,
        ANGLE,
        sums,
        np.full(len(sums), step),
        np.full(3, WALK),
        np.full(3, WALK),
    )


IDEAL = (np.eye(3), np.zeros(3))
SENSOR = (
    np.eye(3) + 1e-3 * np.array([[0.6, 2.2, 7.6], [-2.7, -0.1, -0.8], [-7.6, 0.7, 0.9]]),
    np.array([3e-5, -2e-5, 1e-5]),
)


def session(
    sensor: tuple[np.ndarray, np.ndarray], random: np.random.Generator | None, known: bool = False
) -> tuple[list[RateSegment], list[StaticRate]]:
    """S3's session: six orientations, each turned about both ways, at rest before and after."""
    turns, stills = [], []
    M, bias = sensor
    for axis in (2, 0, 1):
        for sign, profile in ((1.0, SLOW), (-1.0, FAST)):
            up = sign * np.eye(3)[axis]
            azimuth = 1.0 if random is None else random.uniform(0, 2 * np.pi)
            lean = NO_LEAN
            if random is not None:
                lean = np.cross(random.normal(0, TILT, 3) * (up == 0), up)
            for way in (1.0, -1.0):
                turns.append(a_turn(up, profile, way, sensor, azimuth, random, lean, known))
            sigma = np.full(3, WALK / np.sqrt(120))
            for _ in range(2):
                mean = M @ (UP * up + LEVEL * azimuths(up, azimuth)) + bias
                mean += 0 if random is None else random.normal(0, sigma)
                stills.append(StaticRate(turns[-1].position, mean, sigma, up))
    return turns, stills


def both_turns(pair: list[RateSegment], axis: int = 2) -> tuple[np.ndarray, np.ndarray]:
    """M u, 1, and D + M E, rad/s, by a turn forward and a turn backward about one axis."""
    values = turn_and_stop(pair, [], NO_EARTH, TILT).by_turns.values
    return values[:9].reshape(3, 3)[:, axis], values[9:]


# ---- what the paper says


def test_t21_turns_last_61_and_31_seconds_and_its_windows_would_be_384_and_432_degrees():
    assert SLOW.seconds == pytest.approx(61) and FAST.seconds == pytest.approx(31)
    for profile, degrees, share in ((SLOW, 384, -0.0625), (FAST, 432, -1 / 6)):
        taken = profile.rate * WINDOWS[profile]
        assert np.degrees(taken) == pytest.approx(degrees)
        pair = [a_turn(np.eye(3)[2], profile, way, IDEAL, 0.3) for way in (1.0, -1.0)]
        assert both_turns(pair)[0][2] == pytest.approx(1, abs=1e-12)
        literal = [replace(turn, angle=np.sign(turn.angle) * taken) for turn in pair]
        assert both_turns(literal)[0][2] - 1 == pytest.approx(share, abs=1e-12)


@pytest.mark.parametrize(
    ("profile", "kept", "drift"), [(SLOW, 2.512e-4, 0.81), (FAST, 3.769e-4, 2.16)]
)
def test_ramps_and_standstill_keep_the_level_earth_rate_alike_in_both_directions(
    profile, kept, drift
):
    up = np.eye(3)[2]
    pair = [a_turn(up, profile, way, IDEAL, 0.7) for way in (1.0, -1.0)]
    sums = np.array([turn.sums.sum(axis=0) for turn in pair])
    np.testing.assert_allclose(sums[0, :2], sums[1, :2], atol=1e-18)
    assert np.linalg.norm(sums[0, :2]) == pytest.approx(kept, rel=3e-4)
    along, offset = both_turns(pair)
    np.testing.assert_allclose(along, up, atol=1e-12)  # the difference is exact
    level = offset[:2] / DEGREE_PER_HOUR  # the sum is not
    assert np.linalg.norm(level) == pytest.approx(drift, abs=0.005)
    assert offset[2] / DEGREE_PER_HOUR == pytest.approx(7.640, abs=5e-4)


def test_t22_sums_of_different_length_must_be_divided_before_they_are_added():
    up, down = (
        both_turns([a_turn(axis, profile, way, IDEAL, 0.7) for way in (1.0, -1.0)])[1]
        for axis, profile in ((np.eye(3)[2], SLOW), (-np.eye(3)[2], FAST))
    )
    undivided = (up[2] * 64 + down[2] * 36) / (64 + 36)
    assert undivided / DEGREE_PER_HOUR == pytest.approx(2.139, abs=5e-4)
    assert (up[2] + down[2]) / 2 == pytest.approx(0, abs=1e-15)


# ---- closure


def test_without_noise_and_with_a_known_azimuth_it_is_exact():
    turns, stills = session(SENSOR, None, known=True)
    assert pairs_of(turns) == [(0, 1), (2, 3), (4, 5), (6, 7), (8, 9), (10, 11)]
    found = turn_and_stop(turns, stills, WUHAN, TILT)
    truth = np.append(*SENSOR)
    # The known level part is summed over the angles that the gyros show, their scale factor errors
    # included: 1 nrad, 0.3 m°/h.
    np.testing.assert_allclose(found.by_turns.values[:9], truth[:9], atol=2e-9)
    np.testing.assert_allclose(found.by_turns.values[9:], truth[9:], atol=2e-9)
    np.testing.assert_allclose(found.by_rests.values[9:], truth[9:], atol=1e-12)
    np.testing.assert_array_equal(found.by_turns.values[:9], found.by_rests.values[:9])


def test_the_truth_comes_back_with_true_sigmas():
    by_turns, by_rests = [], []
    for seed in range(25):
        random = np.random.default_rng(seed)
        found = turn_and_stop(*session(SENSOR, random), WUHAN, TILT)
        for pulls, solution in ((by_turns, found.by_turns), (by_rests, found.by_rests)):
            pulls.append((solution.values - np.append(*SENSOR)) / solution.sigma)
    assert np.std(by_turns) == pytest.approx(1, abs=0.15)
    assert np.std(by_rests) == pytest.approx(1, abs=0.15)


def test_the_bias_by_turns_carries_the_level_part_that_ramps_leave():
    """With an unknown azimuth: 0.81 and 2.16 °/h as random directions, of six orientations."""
    turns, stills = session(SENSOR, None)
    quiet = [replace(turn, quiet_density=np.zeros(3), angle_sigma=0.0) for turn in turns]
    sigma = turn_and_stop(quiet, stills, WUHAN, 0.0).by_turns.sigma[9:]
    # Each gyro is level in four orientations, two slow and two fast ones.
    expected = np.sqrt(2 * (0.81**2 + 2.16**2) / 2) / 6
    np.testing.assert_allclose(sigma / DEGREE_PER_HOUR, expected, rtol=0.02)


def test_what_nobody_turned_about_is_not_determined():
    turns, stills = session(SENSOR, np.random.default_rng(3), known=True)
    found = turn_and_stop(turns[:8], stills, WUHAN, TILT)  # about z and x alone
    there = found.by_turns.determined.tolist()
    assert there == [True, False, True] * 3 + [True] * 3
    pulls = (found.by_turns.values - np.append(*SENSOR)) / found.by_turns.sigma
    assert np.nanmax(np.abs(pulls)) < 4.5
    gap = replace(turns[0], gaps=(Gap(300, 12.0, np.zeros(len(turns[0].seconds))),))
    assert pairs_of([gap, *turns[1:]]) == pairs_of(turns)[1:]
    other_end = [replace(t, about=-t.about, angle=-t.angle) if t.angle < 0 else t for t in turns]
    told = turn_and_stop(other_end[:8], stills, WUHAN, TILT).by_turns
    np.testing.assert_allclose(told.values, found.by_turns.values, atol=1e-15)
    one_way = turn_and_stop(turns[::2], stills, WUHAN, TILT)
    assert one_way.by_turns is None and not one_way.by_rests.determined[:9].any()
    assert turn_and_stop(turns, [], WUHAN, TILT).by_rests is None


def test_unequal_durations_and_angles_are_solved_as_they_are():
    pair = [
        a_turn(np.eye(3)[0], profile, way, SENSOR, 0.2)
        for profile, way in ((SLOW, 1.0), (FAST, -1.0))
    ]
    along, offset = both_turns(pair, 0)
    M, bias = SENSOR
    # The upward part is the same share of both windows; the level parts differ here by 1.35 °/h.
    np.testing.assert_allclose(along, M[:, 0], atol=5e-5)
    np.testing.assert_allclose(offset, bias + UP * M[:, 0], atol=3 * DEGREE_PER_HOUR)
    steady = [replace(turn, sums=turn.sums - np.outer(turn.seconds, UP * M[:, 0])) for turn in pair]
    np.testing.assert_allclose(both_turns(steady, 0)[0], along, atol=1e-12)


# ---- the accelerometers


def stops(positions: tuple[str, ...], random: np.random.Generator) -> list[StaticForce]:
    """Two stops of 120 s at each of six attitudes, each named by `positions`."""
    M, bias, sigma, tilt = SENSOR[0], np.array([-5e-3, 5e-3, -2e-3]), np.full(3, 1e-5), 1e-5
    rests = []
    for up in [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)]:
        for stop in range(2):
            lean = np.cross(random.normal(0, tilt, 3), up)
            mean = M @ (GRAVITY * (up + lean)) + bias + random.normal(0, sigma)
            rests.append(StaticForce(f"{up} {positions[stop]}", up, mean, sigma))
    return rests


def test_the_two_stops_of_an_orientation_count_as_one_position():
    pulls = []
    for seed in range(50):
        rests = stops(("forward", "backward"), np.random.default_rng(seed))
        found = pooled_positions(rests, GRAVITY, 0.0, 1e-5)
        truth = np.append(SENSOR[0], [-5e-3, 5e-3, -2e-3])
        pulls.append((found.values - truth) / found.sigma)
    assert np.std(pulls) == pytest.approx(1, abs=0.12)
    # The same number of stops everywhere: it is S0's formula.
    unknowns, covariance = six_position_formula(rests, GRAVITY, 0.0, 1e-5)
    np.testing.assert_allclose(found.values, unknowns, atol=1e-13)
    sigma = np.sqrt(np.diag(covariance))  # there tilts do not pass M, whose cross terms are 8e-3
    np.testing.assert_allclose(found.sigma, sigma, rtol=0.01)


def test_stops_that_differ_lessen_the_error_of_the_table_and_others_do_not():
    random = np.random.default_rng(1)
    other = pooled_positions(stops(("forward", "backward"), random), GRAVITY, 0.0, 1e-4)
    same = pooled_positions(stops(("same", "same"), random), GRAVITY, 0.0, 1e-4)
    cross = 1  # cross_xy, whose error is the tilt
    assert same.sigma[cross] / other.sigma[cross] == pytest.approx(np.sqrt(2), rel=0.01)


def test_a_position_with_more_stops_counts_no_more_than_the_others():
    random = np.random.default_rng(2)
    rests = stops(("forward", "backward"), random)
    uneven = rests[:1] + rests[2:]
    found = pooled_positions(uneven, GRAVITY, 0.0, 1e-5)
    means = np.array(
        [uneven[0].mean] + [(uneven[i].mean + uneven[i + 1].mean) / 2 for i in range(1, 11, 2)]
    )
    ups = [uneven[0].up] + [uneven[i].up for i in range(1, 11, 2)]
    by_hand = [
        StaticForce(str(up), up, mean, np.zeros(3)) for up, mean in zip(ups, means, strict=True)
    ]
    np.testing.assert_allclose(
        found.values, six_position_formula(by_hand, GRAVITY, 0.0, 0.0)[0], atol=1e-13
    )
    assert pooled_positions(rests[:4], GRAVITY, 0.0, 1e-5) is None
    assert pooled_positions([], GRAVITY, 0.0, 1e-5) is None
