"""Effects against what follows from their definition by other means: exact rotations, integrals."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from inertial.effects import CATALOGUE
from inertial.effects.accel_hysteresis import hysteresis
from inertial.effects.gyro_bias_sense import last_sense
from inertial.effects.gyro_hysteresis import course
from inertial.physics.effect import Reading, Truth
from inertial.physics.forward import Site, Triad, predict, rate_of, truth_of
from inertial.physics.motion import Motion, Profile, joined, stretches, turning
from inertial.physics.site import earth_rate

DEGREE = np.radians(1)
GRAVITY = 9.79
SITE = Site(GRAVITY, *earth_rate(30 * DEGREE))
STILL = Site(GRAVITY, 0.0, 0.0)  # where the earth does not turn
EXACT = Triad(np.eye(3), np.zeros(3))
# The case lies on a side, oblique.
UP, NORTH = np.array([0.96, 0.0, 0.28]), np.array([0.0, 1.0, 0.0])
EAST = np.cross(NORTH, UP)
STEP = 1e-3  # s


def on_a_turn(angle: np.ndarray, about: np.ndarray = UP) -> Motion:
    """A turn with these angles one millisecond apart."""
    rate = np.gradient(angle, STEP)
    time = STEP * np.arange(len(angle))
    seconds = np.full(len(angle), STEP)
    acceleration = np.gradient(rate, STEP)
    turn = turning(about, UP, NORTH, angle, rate, acceleration, time, seconds)
    return replace(turn, surveyed=np.ones(len(angle), bool))


def acted(name: str, values: list[float], motion: Motion, site: Site = STILL, at=None):
    """What an effect adds to the readings of exact sensors."""
    effect = CATALOGUE[name] if at is None else CATALOGUE[name].fixed(at)
    triads = (motion, site, EXACT, EXACT)
    plain = predict(*triads)
    read = predict(*triads, [effect], {effect.label: np.array(values)})
    return read.gyro - plain.gyro, read.accel - plain.accel


def sensed(attitudes: Rotation, arm: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Rate and specific force of a case whose attitudes, body to laboratory, are these."""
    between = (attitudes[:-1].inv() * attitudes[1:]).as_rotvec() / STEP
    rate = (between[:-1] + between[1:]) / 2
    pull = np.tile([0.0, 0.0, GRAVITY], (len(attitudes) - 2, 1))
    if arm is not None:
        place = attitudes.apply(arm)
        pull = pull + (place[2:] - 2 * place[1:-1] + place[:-2]) / STEP**2
    return rate, attitudes[1:-1].inv().apply(pull)


# East, north, up of the laboratory, from body axes at the start of a turn.
AT_START = Rotation.from_matrix(np.stack([EAST, NORTH, UP]))
ANGLES = 0.3 * np.cumsum(np.sin(np.linspace(0, np.pi, 2001))) * STEP * 10
VERTICAL = np.array([0.0, 0.0, 1.0])


def about_the_vertical(angles: np.ndarray) -> Rotation:
    return Rotation.from_rotvec(angles[:, None] * VERTICAL)


def lean(north: float, east: float) -> np.ndarray:
    """The rotation, in the laboratory, that leans the vertical so."""
    return np.cross(VERTICAL, np.array([east, north, 0.0]))


@pytest.mark.parametrize(
    "name, attitudes",
    [
        ("table_tilt", lambda tilt: Rotation.from_rotvec(tilt) * about_the_vertical(ANGLES)),
        (
            "table_wobble",
            lambda tilt: (
                Rotation.from_rotvec(about_the_vertical(2 * ANGLES).apply(tilt))
                * about_the_vertical(ANGLES)
            ),
        ),
    ],
)
@pytest.mark.parametrize("north, east", [(1e-4, 0.0), (0.0, 1e-4)])
def test_leans_of_the_table_by_exact_rotations(name, attitudes, north, east):
    leaning = sensed(attitudes(lean(north, east)) * AT_START)
    level = sensed(about_the_vertical(ANGLES) * AT_START)
    gyro, accel = acted(name, [north, east], on_a_turn(ANGLES))
    assert np.abs(accel).max() > 9e-4
    np.testing.assert_allclose(accel[1:-1], leaning[1] - level[1], atol=2e-7)
    np.testing.assert_allclose(gyro[1:-1], leaning[0] - level[0], atol=5e-8)  # 2 δ² ω


@pytest.mark.parametrize("north, east", [(1e-3, 0.0), (0.0, 1e-3)])
def test_a_table_that_leans_feels_another_part_of_the_earth_rate(north, east):
    attitudes = about_the_vertical(ANGLES) * AT_START
    leaning = Rotation.from_rotvec(lean(north, east)) * attitudes
    earth = np.array([0.0, SITE.earth_level, SITE.earth_up])
    motion = on_a_turn(ANGLES)
    gyro = acted("table_tilt", [north, east], motion, SITE)[0]
    gyro -= acted("table_tilt", [north, east], motion, STILL)[0]
    assert np.abs(gyro).max() > 3e-8
    exact = leaning.inv().apply(earth) - attitudes.inv().apply(earth)
    np.testing.assert_allclose(gyro, exact, atol=1e-10)  # δ² Ω
    # Where the azimuth is not known the gyros tell the level part, which absorbs all but its size.
    unknown = replace(motion, surveyed=np.zeros(len(ANGLES), bool))
    upward = acted("table_tilt", [north, east], unknown, SITE)[0]
    upward -= acted("table_tilt", [north, east], unknown, STILL)[0]
    seen = np.sum(exact * motion.up, axis=1, keepdims=True) * motion.up
    np.testing.assert_allclose(upward, seen, atol=1e-10)
    level = np.hypot(*Rotation.from_rotvec(lean(north, east)).inv().apply(earth)[:2])
    change = CATALOGUE["table_tilt"].level_rate_changes(SITE.earth_up, SITE.earth_level)
    assert np.array([north, east]) @ change == pytest.approx(level - SITE.earth_level, abs=1e-10)


def test_a_tilt_with_a_course_is_that_share_of_a_tilt_and_the_gyros_feel_it_grow():
    motion, lean_2d = (
        replace(on_a_turn(np.zeros(3)), time=np.array([0.0, 1800.0, 3600.0])),
        [2e-5, 1e-5],
    )
    gyro, accel = acted("table_tilt", lean_2d, motion)
    rates = [size / 3600 for size in lean_2d]
    gyro_ramp, accel_ramp = acted("table_tilt_ramp", rates, motion)
    np.testing.assert_allclose(accel_ramp, np.array([[0], [0.5], [1]]) * accel, atol=1e-9)
    felt = AT_START.inv().apply(lean(*rates))
    earth = np.array([[0], [0.5], [1]]) * gyro
    np.testing.assert_allclose(gyro_ramp - earth, [felt] * 3, atol=1e-12)
    gyro_jump, accel_jump = acted("table_tilt_jump", lean_2d, motion, at=900.0)
    np.testing.assert_allclose(accel_jump, np.array([[0], [1], [1]]) * accel, atol=1e-12)
    np.testing.assert_allclose(gyro_jump, np.array([[0], [1], [1]]) * gyro, atol=1e-15)


def test_a_scale_of_the_angle_leaves_the_case_off_until_a_position_is_set():
    """A turn about north, one about east from where that ends, and one about east set anew."""
    scale, whole, n = 1e-5, ANGLES[-1], len(ANGLES)
    rate, still = np.gradient(ANGLES, STEP), np.full(n, STEP)
    motions, exact = [], []
    for place, (axis, before) in enumerate([(NORTH, 0.0), (EAST, whole), (EAST, 0.0)]):
        start = Rotation.from_rotvec(before * NORTH).inv()
        at_start = start.apply(UP), start.apply(NORTH)
        turn = turning(axis, *at_start, ANGLES, rate, np.gradient(rate, STEP), still, still)
        at = {"visit": np.full(n, float(place)), "position": np.full(n, place // 2)}
        motions.append(replace(turn, surveyed=np.ones(n, bool), **at))
        felt = [
            (Rotation.from_rotvec(k * before * NORTH) * Rotation.from_rotvec(turned)).inv()
            for k in (1 + scale, 1.0)
            for turned in [np.outer(k * ANGLES, axis)]
        ]
        exact.append(felt[0].apply(GRAVITY * UP) - felt[1].apply(GRAVITY * UP))
    accel = acted("table_angle_scale", [scale], joined(motions), SITE)[1]
    np.testing.assert_allclose(accel, np.concatenate(exact), atol=3e-8)  # 2 (δ ϑ)² g
    assert np.abs(accel[n]).max() > 100 * max(np.abs(accel[0]).max(), np.abs(accel[2 * n]).max())


@pytest.mark.parametrize("lean, quarter", [(1e-4, 0.0), (0.0, 1e-4)])
def test_a_middle_axis_that_leans_by_exact_rotations(lean, quarter):
    """From where z was up it has turned the case about the south, so that x came up."""
    angle = np.arccos(UP[2])
    south = np.array([0.0, -1.0, 0.0])
    leaning = np.cos(lean) * south + np.sin(lean) * VERTICAL
    turned = Rotation.from_rotvec((angle + quarter * np.sin(angle)) * leaning)
    missed = turned * Rotation.from_rotvec(angle * south).inv()
    home = AT_START.inv() * Rotation.from_rotvec(angle * south)
    np.testing.assert_allclose(home.inv().apply([0, 0, 1.0]), [0, 0, 1], atol=1e-12)
    off = sensed(about_the_vertical(ANGLES) * missed * AT_START)
    right = sensed(about_the_vertical(ANGLES) * AT_START)
    motion = on_a_turn(ANGLES)
    gyro, accel = acted("table_axis_non_orthogonality", [lean, quarter], motion)
    assert np.abs(accel).max() > 5e-4
    np.testing.assert_allclose(accel[1:-1], off[1] - right[1], atol=2e-7)
    np.testing.assert_allclose(gyro[1:-1], off[0] - right[0], atol=5e-8)


SOUTH = np.array([0.0, -1.0, 0.0])
TILTED = Rotation.from_rotvec(np.arccos(UP[2]) * SOUTH)


def on_three_axes(turning_axis):
    """A turn about an axis of a table of which the middle one points south, turned as `TILTED`.

    The motion, and its attitudes as a function of the rotation by the middle axis.
    """
    on_table = TILTED.inv() * AT_START  # the case with the middle axis at zero
    about = {"inner": VERTICAL, "middle": on_table.inv().apply(SOUTH), "outer": UP}[turning_axis]

    def attitudes(tilted: Rotation) -> Rotation:
        if turning_axis == "inner":
            return tilted * about_the_vertical(ANGLES) * on_table
        axis = SOUTH if turning_axis == "middle" else VERTICAL
        return Rotation.from_rotvec(np.outer(ANGLES, axis)) * tilted * on_table

    return on_a_turn(ANGLES, about), attitudes


@pytest.mark.parametrize("turning_axis", ["inner", "middle", "outer"])
def test_an_inner_axis_that_leans_by_exact_rotations(turning_axis):
    """The inner axis, on which the case sits, leans towards the south, the middle axis."""
    lean = 1e-4
    motion, attitudes = on_three_axes(turning_axis)
    leaning = TILTED * Rotation.from_rotvec(lean * np.cross(VERTICAL, SOUTH))
    off, right = sensed(attitudes(leaning)), sensed(attitudes(TILTED))
    gyro, accel = acted("table_inner_axis", [lean], motion)
    np.testing.assert_allclose(accel[1:-1], off[1] - right[1], atol=2e-7)
    np.testing.assert_allclose(gyro[1:-1], off[0] - right[0], atol=5e-8)
    if turning_axis == "inner":
        assert np.abs(gyro).max() == 0 and np.abs(accel).max() > 2e-4
    if turning_axis == "middle":
        assert np.abs(gyro).max() > 1e-4  # of 1.9 rad/s


@pytest.mark.parametrize("turning_axis", ["inner", "middle", "outer"])
def test_another_zero_of_the_middle_axis_by_exact_rotations(turning_axis):
    """The middle axis has turned further; the inner one goes along."""
    further = 1e-4
    motion, attitudes = on_three_axes(turning_axis)
    shifted = Rotation.from_rotvec(further * SOUTH) * TILTED
    off, right = sensed(attitudes(shifted)), sensed(attitudes(TILTED))
    for name in ("table_zero_shift", "table_zero_shift_outer"):
        gyro, accel = acted(name, [0.0, 0.0, further], motion, at=-1.0)
        np.testing.assert_allclose(accel[1:-1], off[1] - right[1], atol=2e-7)
        np.testing.assert_allclose(gyro[1:-1], off[0] - right[0], atol=5e-8)
        assert np.abs(accel).max() > 2e-4 and (np.abs(gyro).max() > 1e-4) == (
            turning_axis == "outer"
        )
        assert not any(part.any() for part in acted(name, [0.0, 0.0, further], motion, at=9.0))


def test_in_means_over_a_turn_about_the_inner_axis_its_lean_stays():
    """A side turned about its level inner axis by 60° a mean, where up is shorter by 5 %."""
    angle, about, east = np.arange(6) * np.pi / 3, VERTICAL, np.array([1.0, 0.0, 0.0])
    rate, still = np.full(6, np.pi / 3), np.zeros(6)
    motion = turning(about, east, NORTH, angle, rate, still, np.arange(6.0), np.ones(6))
    share = np.sinc(1 / 6)
    _gyro, accel = acted(
        "table_zero_shift", [0.0, 0.0, 1e-4], replace(motion, up=share * motion.up), at=-1.0
    )
    np.testing.assert_allclose(accel, [[0.0, 0.0, -1e-4 * GRAVITY]] * 6, atol=1e-9)


def test_axes_at_other_than_right_angles_leave_a_case_upright_alone():
    flat = replace(on_a_turn(ANGLES), up=np.tile(VERTICAL, (len(ANGLES), 1)), about=VERTICAL)
    assert not acted("table_axis_non_orthogonality", [1e-4, 1e-4], flat)[1].any()


def test_a_side_whose_azimuth_is_not_known_does_not_tell_the_middle_axis():
    side = on_a_turn(ANGLES)
    unknown = replace(side, north=np.full_like(side.north, np.nan))
    flat = replace(side, up=np.tile(-VERTICAL, (len(ANGLES), 1)), about=VERTICAL)
    alone = acted("table_axis_non_orthogonality", [1e-4, 1e-4], joined([side, flat]))
    beside = acted("table_axis_non_orthogonality", [1e-4, 1e-4], joined([unknown, side, flat]))
    for sensor, other in zip(beside, alone, strict=True):
        assert other[len(ANGLES) :].any()
        np.testing.assert_allclose(sensor[len(ANGLES) :], other, atol=1e-15)


@pytest.mark.parametrize("name", ["lever_arm", "size_effect"])
def test_an_arm_by_the_second_derivative_of_the_place(name):
    arm = np.array([0.05, -0.03, 0.02])
    attitudes = about_the_vertical(ANGLES) * AT_START
    felt = sensed(attitudes, arm)[1] - sensed(attitudes)[1]
    values = list(arm) if name == "lever_arm" else [*arm, *arm, *arm]
    _, accel = acted(name, values, on_a_turn(ANGLES))
    assert np.abs(felt).max() > 0.1
    np.testing.assert_allclose(accel[2:-2], felt[1:-1], atol=1e-3 * np.abs(felt).max())


def test_late_gyros_say_what_was_so_much_earlier():
    moved = on_a_turn(ANGLES)
    gyro, accel = acted("gyro_latency", [2 * STEP], moved)
    earlier = moved.omega[:-4] - moved.omega[2:-2]
    np.testing.assert_allclose(gyro[4:-4], earlier[2:-2], atol=2e-3 * np.abs(earlier).max())
    assert not accel.any()


def test_late_accelerometers_say_what_was_so_much_earlier():
    gyro, accel = acted("accel_latency", [2 * STEP], on_a_turn(ANGLES, EAST))
    _, felt = sensed(AT_START * Rotation.from_rotvec(ANGLES[:, None] * EAST))
    earlier = felt[:-2] - felt[2:]  # centred, as by τ df/dt
    np.testing.assert_allclose(accel[2:-2], earlier, atol=3e-3 * np.abs(earlier).max())
    assert np.abs(earlier).max() > 1e-3 and not gyro.any()


@pytest.mark.parametrize("order", [1.0, 7.25])
def test_a_ripple_is_the_change_of_what_the_table_is_ahead(order):
    moved = on_a_turn(ANGLES)
    a, b = 1e-4, 2e-4
    name, at = ("table_eccentricity", None) if order == 1 else ("table_ripple", order)
    gyro, _ = acted(name, [a, b], moved, at=at)
    ahead = a * np.sin(order * ANGLES) + b * np.cos(order * ANGLES)
    summed = np.cumsum(gyro @ UP) * STEP
    np.testing.assert_allclose(summed, ahead - ahead[0], atol=3e-6)


def test_a_tumble_stands_where_its_circle_does_not_say():
    """About the north, by exact rotations of gravity and of the earth's rate."""
    a, b, angles = 1e-5, 2e-5, np.radians([0.0, 50.0, 90.0, 200.0])
    off = a * np.sin(angles) + b * (np.cos(angles) - 1)
    shown, true = (Rotation.from_rotvec(np.outer(t, NORTH)).inv() for t in (angles, angles + off))
    still = stretches(np.arange(4.0), np.ones(4), np.full(4, np.nan))
    up, north = shown.apply(UP), shown.apply(NORTH)
    rests = replace(still, up=up, north=north, tumbled=np.outer(angles, NORTH))
    gyro, accel = acted("tumble_eccentricity", [a, b], rests, SITE)
    earth = SITE.earth_rate(UP, NORTH)
    np.testing.assert_allclose(gyro, true.apply(earth) - shown.apply(earth), atol=1e-13)
    np.testing.assert_allclose(accel, GRAVITY * (true.apply(UP) - up), atol=1e-8)  # δ² g / 2


def test_a_whole_turn_is_free_of_a_ripple_and_a_half_turn_is_not():
    for turns, left in ((1.0, 0.0), (0.5, -2e-4)):
        edges = np.linspace(0, turns * 2 * np.pi, 101)  # from block to block
        middle, rate = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / STEP
        moved = replace(on_a_turn(middle), rate=rate)
        gyro, _ = acted("table_eccentricity", [3e-4, 1e-4], moved)
        assert (gyro @ UP).sum() * STEP == pytest.approx(left, abs=1e-12)


def test_another_speed_is_sooner_over_and_adds_no_angle():
    block = 0.2
    edges = block * np.arange(186)  # 37 s
    set_angle = Profile(2 * np.pi, 10 * DEGREE, 10 * DEGREE)
    faster = Profile(2 * np.pi, 10.01 * DEGREE, 10 * 1.001**2 * DEGREE)  # θ(1.001 t)
    steps = [np.diff(profile.at(edges)[0]) / block for profile in (set_angle, faster)]
    rates = np.concatenate([[0.0], (steps[0][1:] + steps[0][:-1]) / 2, [0.0]])
    moved = replace(
        on_a_turn(np.cumsum(steps[0]) * block),
        rate=steps[0], acceleration=np.diff(rates) / block,
        time=edges[:-1] + block / 2, seconds=np.full(185, block),
    )  # fmt: skip
    gyro, _ = acted("table_speed_error", [1e-3], moved)
    assert abs(np.sum(gyro @ UP) * block) < 1e-15
    # About the middle of the turn, for when it begins is not told by a speed.
    both = steps[1] - steps[0] - 1e-3 * 18.5 * moved.acceleration
    np.testing.assert_allclose((gyro @ UP)[6:-6], both[6:-6], atol=1e-6)
    assert np.abs(gyro @ UP).max() > 1e-4


@pytest.mark.parametrize("name", ["gyro_warm_up", "accel_warm_up"])
def test_a_warm_up_in_a_long_rest_is_its_mean(name):
    rests = replace(
        on_a_turn(np.zeros(3)), time=np.array([150.0, 450, 900]), seconds=np.full(3, 300.0)
    )
    read = np.hstack(acted(name, [1.0, 0, 0], rests, at=120.0))
    column = 0 if name.startswith("gyro") else 3
    for i, middle in enumerate(rests.time):
        mean = quad(lambda t: np.exp(-t / 120) / 300, middle - 150, middle + 150)[0]
        assert read[i, column] == pytest.approx(mean, rel=1e-6)


@pytest.mark.parametrize("name", ["gyro_bias_jump", "accel_bias_jump"])
def test_a_jump_within_a_rest_counts_for_what_is_behind_it(name):
    rests = replace(
        on_a_turn(np.zeros(3)), time=np.array([150.0, 450, 750]), seconds=np.full(3, 300.0)
    )
    read = np.hstack(acted(name, [0, 1.0, 0], rests, at=400.0))
    np.testing.assert_allclose(read[:, 1 if name.startswith("gyro") else 4], [0, 2 / 3, 1])


def test_a_case_that_has_turned_sees_everything_turned_the_other_way():
    angle, turned = DEGREE * np.arange(3) * 0.01, np.array([1e-5, -2e-5, 3e-5])
    motion = replace(on_a_turn(angle), time=np.array([150.0, 450, 750]), seconds=np.full(3, 300.0))
    back, share = Rotation.from_rotvec(turned).inv(), np.array([0, 2 / 3, 1])[:, None]
    truth = truth_of(motion, STILL)
    for read, true in zip(
        acted("mounting_shift", turned.tolist(), motion, at=400.0),
        (truth.rate, truth.force),
        strict=True,
    ):
        np.testing.assert_allclose(read, share * (back.apply(true) - true), atol=1e-8)
        assert np.abs(read[2]).max() > 1e-6


def test_a_case_that_slips_in_a_turn_sees_itself_turn_and_then_everything_turned():
    """Over the whole turn the gyros see θ more; from t₀ on all is turned the other way."""
    turned, step = np.array([1e-5, -2e-5, 3e-5]), np.pi / 100
    angles = step * (np.arange(100) + 0.5)  # of stretches, each at its middle
    motion = on_a_turn(np.append(angles, [np.pi] * 3))
    visit = np.append(np.full(100, 2.5), [3.0] * 3)
    motion = replace(motion, visit=visit, rate=np.append(np.full(100, step / STEP), [0] * 3))
    gyro, accel = acted("mounting_slip", turned.tolist(), motion, at=39.5 * STEP)
    truth, back = truth_of(motion, STILL), Rotation.from_rotvec(turned).inv()
    share = np.where(np.arange(103) < 40, 0.0, 1.0)[:, None]
    np.testing.assert_allclose(accel, share * (back.apply(truth.force) - truth.force), atol=1e-8)
    seen = gyro - share * (back.apply(truth.rate) - truth.rate)
    np.testing.assert_allclose(seen[:100].sum(axis=0) * STEP, turned, rtol=1e-3)
    np.testing.assert_allclose(seen[100:], 0.0, atol=1e-12)


def test_hysteresis_remembers_the_side_from_which_an_axis_came():
    force = GRAVITY * np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    visits = np.array([0.0, 1, 2, 3])
    unseen = np.full((4, 3), np.nan)

    def close(order, sides, axis, expected):
        found = hysteresis(force, order, sides)[:, axis]
        np.testing.assert_allclose(found, expected, atol=7e-3)  # 9.79 is not quite g

    close(visits, unseen, 0, [0, 1, 0, -1])
    close(visits, unseen, 2, [0, 0, 0, 0])
    # The order of the plan counts, not that of the rows.
    close(visits[::-1], unseen, 0, [0, -1, 0, 0])
    # On the way to the last the table turned x over, as the log shows.
    seen = unseen.copy()
    seen[3] = (GRAVITY, np.nan, np.nan)
    close(visits, seen, 0, [0, 1, 0, 1])
    rests = replace(on_a_turn(np.zeros(4)), up=force / GRAVITY, visit=visits)
    _, accel = acted("accel_hysteresis", [1e-4, 0, 0], rests)
    np.testing.assert_allclose(accel[:, 0], [0, 1e-4, 0, -1e-4], atol=7e-7)
    # Rayleigh 1887: the first rise to g/2 is r = 2 u (u − 1), and u²/4 is left of it at zero; after
    # g the way back is 1 − u².
    fraction = np.array([0.5, 0.0, 1.0, 0.5])
    up = np.column_stack([fraction, np.sqrt(1 - fraction**2), 0 * fraction])
    forces = 9.80665 * up
    loop = hysteresis(forces, visits, np.full((4, 3), np.nan))[:, 0]
    np.testing.assert_allclose(loop, [-0.5, 0.25, 0.0, 0.75], atol=3e-3)


def test_gyros_remember_whether_the_rate_rose_or_fell():
    about_x = DEGREE * np.array([0.0, 4, 10, 10, 6, 0, 0, -10, -9.8, 0])
    visits = np.array([0.0, 1.3, 1.3, 1.3, 1.3, 1.7, 2, 3, 3, 4])
    rate, unseen = np.outer(about_x, [1.0, 0, 0]), np.full((10, 3), np.nan)
    loop = course(rate, visits, unseen)
    # 0.2 °/s are no change of course, only elastic: 1 of 2.5 parts of the way
    expected = [0, 1, 1, 1, -1, -1, -1, -1, -0.6, 1]
    np.testing.assert_allclose(loop[:, 0], expected, atol=1e-12)
    assert not loop[:, 1:].any()
    mixed = np.roll(np.arange(10), 3)  # the order of the plan counts
    np.testing.assert_allclose(course(rate[mixed], visits[mixed], unseen), loop[mixed], atol=1e-12)
    # On the way to the third the table turned back, and last about y; in a visit that counts once.
    seen = unseen.copy()
    seen[6] = (-1, 1, np.nan)
    seen[4:6] = 1
    loop = course(rate, visits, seen)
    np.testing.assert_allclose(loop[6:, 0], [1, -1, -0.6, 1], atol=1e-12)
    np.testing.assert_allclose(loop[:, 1], [0] * 6 + [-1] * 4, atol=1e-12)
    kept = last_sense(rate, visits, seen)  # 4 and 10 °/s are turns; 0 and 0.2 °/s are none
    np.testing.assert_array_equal(kept[:, 0], [0, 1, 1, 1, 1, 1, -1, -1, -1, -1])
    np.testing.assert_array_equal(kept[:, 1], [0] * 6 + [1] * 4)
    np.testing.assert_array_equal(last_sense(rate[mixed], visits[mixed], seen[mixed]), kept[mixed])
    turn = replace(on_a_turn(np.zeros(10)), about=np.array([1.0, 0, 0]), rate=about_x, visit=visits)
    gyro, _ = acted("gyro_bias_sense", [2e-6, 0, 0], turn)
    np.testing.assert_allclose(gyro[[0, 1, 5, 7, 9], 0], [0, 2e-6, 2e-6, -2e-6, -2e-6], rtol=0.01)
    gyro, _ = acted("gyro_hysteresis", [2e-6, 0, 0], turn)
    np.testing.assert_allclose(gyro[[1, 5, 9], 0], [-2e-6, 2e-6, -2e-6], rtol=0.01)


def test_sites_that_are_wrong_by_their_own_formulas():
    moved = on_a_turn(ANGLES)
    truth = truth_of(moved, SITE)
    wrong = 1e-3
    there = truth_of(moved, Site(GRAVITY, *earth_rate(30 * DEGREE + wrong)))
    gyro, _ = acted("latitude_error", [wrong], moved, SITE)
    np.testing.assert_allclose(gyro, there.rate - truth.rate, atol=1e-10)
    south = truth_of(moved, Site(GRAVITY, *earth_rate(-30 * DEGREE)))
    gyro, _ = acted("latitude_sign", [1.0], moved, SITE)
    np.testing.assert_allclose(gyro, south.rate - truth.rate, atol=1e-18)
    # North lies further counter-clockwise, seen from above.
    north = Rotation.from_rotvec(wrong * UP).apply(moved.north)
    gyro, _ = acted("heading_error", [wrong], moved, SITE)
    elsewhere = truth_of(replace(moved, north=north), SITE)
    np.testing.assert_allclose(gyro, elsewhere.rate - truth.rate, atol=1e-10)
    # About an angle that is large they are exact there.
    far = 0.7
    gyro, _ = acted("latitude_error", [far], moved, SITE, at=far)
    there = truth_of(moved, Site(GRAVITY, *earth_rate(30 * DEGREE + far)))
    np.testing.assert_allclose(gyro, there.rate - truth.rate, atol=1e-18)
    north = Rotation.from_rotvec(far * UP).apply(moved.north)
    gyro, _ = acted("heading_error", [far], moved, SITE, at=far)
    elsewhere = truth_of(replace(moved, north=north), SITE)
    np.testing.assert_allclose(gyro, elsewhere.rate - truth.rate, atol=1e-18)
    gyro, _ = acted("earth_rate_omitted", [1.0], moved, SITE)
    np.testing.assert_allclose(gyro, truth_of(moved, STILL).rate - truth.rate, atol=1e-18)
    _, accel = acted("gravity_error", [1e-3], moved, SITE)
    heavier = truth_of(moved, Site(GRAVITY + 1e-3, 0, 0))
    np.testing.assert_allclose(accel, heavier.force - truth.force, atol=1e-12)


def test_a_slow_clock_leaves_the_angle_of_a_turn_and_enlarges_the_rest():
    moved = on_a_turn(ANGLES)
    truth = truth_of(moved, SITE)
    gyro, accel = acted("clock_scale", [1e-3], moved, SITE)
    # The table turns by the same angle in the stated interval; the earth has longer for it.
    np.testing.assert_allclose(gyro, 1e-3 * (truth.rate - moved.omega), atol=1e-16)
    np.testing.assert_allclose(accel, 1e-3 * truth.force, rtol=1e-9)


def test_a_dead_band_swallows_the_earth_at_rest_and_nothing_of_a_turn():
    at_rest = on_a_turn(np.zeros(5))
    earth = truth_of(at_rest, SITE).rate
    turn = on_a_turn(0.2 * STEP * np.arange(5), np.ones(3) / np.sqrt(3))
    for i, axis in enumerate("xyz"):
        gyro, _ = acted(f"gyro_dead_band_{axis}", [0.7], at_rest, SITE, at=1e-4)
        np.testing.assert_allclose(gyro[:, i], -0.7 * earth[:, i], atol=1e-18)
        assert not np.delete(gyro, i, axis=1).any()
        assert not acted(f"gyro_dead_band_{axis}", [0.7], turn, SITE, at=1e-4)[0].any()
    outside = acted("gyro_dead_band_z", [1.0], at_rest, SITE, at=0.99 * abs(earth[0, 2]))[0]
    assert earth[0, 2] and not outside.any()


def test_triads_that_are_mounted_askew_see_the_rate_in_other_axes():
    moved = on_a_turn(ANGLES)
    phi = np.array([1e-4, -2e-4, 3e-4])
    gyro, accel = acted("gyro_accel_misalignment", list(phi), moved, SITE)
    turned = Rotation.from_rotvec(phi).inv().apply(truth_of(moved, SITE).rate)
    np.testing.assert_allclose(gyro, turned - truth_of(moved, SITE).rate, atol=5e-7)  # φ² ω
    assert not accel.any()


@pytest.mark.parametrize(
    "names, size",
    [
        (["latitude_error"], 1e-3),
        (["earth_rate_omitted"], 1.0),
        (["latitude_sign"], 1.0),
        (["clock_scale"], 1e-3),
        ([f"gyro_dead_band_{axis}" for axis in "xyz"], 1.0),
    ],
)
def test_an_azimuth_that_the_gyros_tell_themselves_is_no_evidence(names, size):
    """It takes up whatever an effect would make of the level part of the earth's rate."""
    found = replace(on_a_turn(np.zeros(5)), surveyed=np.zeros(5, bool))
    at = 1e-4 if len(names) > 1 else None
    gyro = sum(acted(name, [size], found, SITE, at=at)[0] for name in names)
    assert np.abs(gyro @ UP).max() > 1e-9
    np.testing.assert_allclose(np.cross(gyro, UP), 0, atol=1e-16)


RATE, FORCE = (0.2, -0.3, 0.1), (3.0, -5.0, 8.0)  # rad/s, m/s²
PAIRS = ((0, 1), (1, 2), (2, 0))  # xy, yz, zx
# What axis i of the sensor reads more, k its own parameters; of matrices k_ij is k[3 i + j].
BY_AXIS = {
    "gyro_g_sensitivity": lambda k, i: sum(k[3 * i + j] * FORCE[j] for j in range(3)),
    "gyro_g2_sensitivity": lambda k, i: k[i] * FORCE[i] ** 2,
    "gyro_rate_products": lambda k, i: sum(
        k[3 * i + n] * RATE[one] * RATE[other] for n, (one, other) in enumerate(PAIRS)
    ),
    "gyro_cross_axis_squares": lambda k, i: sum(
        k[2 * i + n] * RATE[j] ** 2 for n, j in enumerate(j for j in range(3) if j != i)
    ),
    "gyro_scale_asymmetry": lambda k, i: k[i] * abs(RATE[i]),
    "gyro_scale_quadratic": lambda k, i: k[i] * RATE[i] * abs(RATE[i]),
    "gyro_scale_cubic": lambda k, i: k[i] * RATE[i] ** 3,
    "gyro_scale_g_dependence": lambda k, i: k[i] * RATE[i] * FORCE[i],
    "gyro_bias_ramp": lambda k, i: k[i] * 700.0,
    "gyro_scale_ramp": lambda k, i: k[i] * 700.0 * RATE[i],
    "gyro_scale_jump": lambda k, i: k[i] * RATE[i],
    "gyro_bias_temperature": lambda k, i: k[i] * 4.0,
    "gyro_scale_temperature": lambda k, i: k[i] * 4.0 * RATE[i],
    "accel_quadratic": lambda k, i: k[i] * FORCE[i] ** 2,
    "accel_cubic": lambda k, i: k[i] * FORCE[i] ** 3,
    "accel_scale_asymmetry": lambda k, i: k[i] * abs(FORCE[i]),
    "accel_cross_products": lambda k, i: sum(
        k[3 * i + n] * FORCE[one] * FORCE[other] for n, (one, other) in enumerate(PAIRS)
    ),
    "accel_bias_ramp": lambda k, i: k[i] * 700.0,
    "accel_scale_ramp": lambda k, i: k[i] * 700.0 * FORCE[i],
    "accel_scale_jump": lambda k, i: k[i] * FORCE[i],
    "accel_bias_temperature": lambda k, i: k[i] * 4.0,
    "accel_scale_temperature": lambda k, i: k[i] * 4.0 * FORCE[i],
}


@pytest.mark.parametrize("name", BY_AXIS)
def test_each_element_acts_on_its_own_axis_as_the_standards_write_it(name):
    """All elements different; 700 s after the start, 4 K above the mean of the campaign."""
    effect = CATALOGUE[name].fixed(0.0) if name.endswith("jump") else CATALOGUE[name]
    values = 1e-3 * np.arange(1.0, len(effect.parameters) + 1)
    still = stretches(np.array([-700.0, 700.0]), np.full(2, 0.01), np.array([289.0, 297.0]))
    truth = Truth(np.tile(RATE, (2, 1)), np.tile(FORCE, (2, 1)))
    read = effect.reads(Reading(np.ones((2, 3)), np.ones((2, 3))), truth, still, values)
    changed, other = (read.gyro, read.accel)[:: 1 if name.startswith("gyro") else -1]
    expected = [1 + BY_AXIS[name](values, i) for i in range(3)]
    np.testing.assert_allclose(changed[1], expected, rtol=1e-12)
    np.testing.assert_array_equal(other, 1.0)


def test_what_is_along_the_axis_of_a_sensor_is_along_that_and_not_along_the_case():
    """Gyros 20 mrad askew: a turn about the case's z is 20 mrad · ω of the x gyro, of one sign."""
    askew = Triad(
        np.array([[1.0, 0.0, 0.02], [0.0, 1.0, 0.0], [-0.02, 0.0, 1.0]]), np.full(3, 1e-3)
    )
    turns = on_a_turn(np.array([0.0, 1e-3, 2e-3]), np.array([0.0, 0.0, 1.0]))
    effect, values = CATALOGUE["gyro_scale_asymmetry"], np.array([5e-4, 3e-4, -2e-4])
    triads = (turns, STILL, askew, EXACT)
    plain = predict(*triads)
    read = predict(*triads, [effect], {effect.label: values})
    np.testing.assert_allclose((read.gyro - plain.gyro)[1], [5e-4 * 0.02, 0, -2e-4], rtol=1e-9)
    sized, force = [(effect, values)], np.zeros((3, 3))
    np.testing.assert_allclose(
        rate_of(read.gyro, askew, sized, turns, force), turns.omega, atol=1e-12
    )
