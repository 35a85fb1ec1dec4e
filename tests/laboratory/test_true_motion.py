"""Gravity, the earth's rotation and the table's, against reckonings of another kind."""

from collections.abc import Callable
from math import cos, pi, radians, sin

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from laboratory import Recording, perform, specify
from laboratory.instants import Instants
from laboratory.motion import Turning, move
from laboratory.placement import place
from laboratory.profiles import Change, Profile, Trapezoid
from laboratory.site import normal_gravity

GRAVITY, LATITUDE, EARTH = 9.7936174, radians(30.5278), 7.292115e-5
GYRO_COUNT, ACCELEROMETER_COUNT = 0.1 / (3600 * 256), 0.05 / 2**15
Performed = Callable[..., Recording]


@pytest.mark.parametrize(("up", "axis", "sign"), [("+x", 0, 1), ("-y", 1, -1), ("+z", 2, 1)])
def test_a_rest_reads_gravity_and_the_earth_to_a_count(
    performed: Performed, up: str, axis: int, sign: int
) -> None:
    recording = performed({"id": "still", "do": "rest", "up": up, "seconds": 50})
    truth = recording.truth["all.asc"]
    force = truth.accelerometer.sum(axis=0) * ACCELEROMETER_COUNT
    angle = truth.gyro.sum(axis=0) * GYRO_COUNT
    level = [i for i in range(3) if i != axis]
    assert force[axis] == pytest.approx(sign * GRAVITY * 50, abs=ACCELEROMETER_COUNT)
    assert force[level] == pytest.approx(0, abs=ACCELEROMETER_COUNT)
    assert angle[axis] == pytest.approx(sign * EARTH * sin(LATITUDE) * 50, abs=GYRO_COUNT)
    level_rate = np.hypot(*angle[level])
    assert level_rate == pytest.approx(EARTH * cos(LATITUDE) * 50, abs=2 * GYRO_COUNT)


def test_a_mark_to_the_east_turns_the_next_axis_to_the_north(performed: Performed) -> None:
    """Azimuth 0 of the fixture's table: x to the north, so y points west, up +z."""
    truth = performed({"id": "still", "do": "rest", "up": "+z", "mark": "+x", "seconds": 50}).truth[
        "all.asc"
    ]
    expected = EARTH * np.array([cos(LATITUDE), 0, sin(LATITUDE)])
    assert truth.rate.mean(axis=0) == pytest.approx(expected, abs=1e-15)
    truth = performed({"id": "still", "do": "rest", "up": "+z", "mark": "-y", "seconds": 50}).truth[
        "all.asc"
    ]
    expected = EARTH * np.array([0, -cos(LATITUDE), sin(LATITUDE)])
    assert truth.rate.mean(axis=0) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("degrees", [360, -360])
def test_a_whole_turn_sums_to_its_angle_and_the_earth_to_a_count(
    performed: Performed, degrees: float
) -> None:
    """10 deg/s and 5 deg/s²: 38 s, and 10 s of rest on both sides."""
    recording = performed(
        {
            "id": "turn",
            "do": "turn",
            "up": "+y",
            "degrees": degrees,
            "rate_deg_s": 10,
            "accel_deg_s2": 5,
        }
    )
    truth = recording.truth["all.asc"]
    assert len(truth.time) == 5800
    angle = truth.gyro.sum(axis=0) * GYRO_COUNT
    expected = radians(degrees) + EARTH * sin(LATITUDE) * 58
    assert angle[1] == pytest.approx(expected, abs=GYRO_COUNT)
    steady = truth.rate[1500:4000, 1]
    assert steady == pytest.approx(np.sign(degrees) * radians(10) + EARTH * sin(LATITUDE))


def test_gravity_and_earth_go_round_in_a_turn_about_a_horizontal_axis(
    performed: Performed,
) -> None:
    """Every sample against scipy's rotations and 64 midpoints, at ramps that split a sample."""
    acceleration, rate, still = radians(60.7), radians(45.3), 10.0
    recording = performed(
        {
            "id": "over",
            "do": "turn",
            "up": "+z",
            "mark": "+x",
            "about": "+x",
            "degrees": 200,
            "rate_deg_s": 45.3,
            "accel_deg_s2": 60.7,
        }
    )
    truth = recording.truth["all.asc"]
    fine = (np.arange(len(truth.time))[:, None] + (np.arange(64) + 0.5) / 64) * 0.01 - still
    ramp = rate / acceleration
    total = radians(200) / rate + ramp
    time = np.clip(fine, 0, total)
    speed = np.interp(time, [0, ramp, total - ramp, total], [0, rate, rate, 0])
    angle = np.where(
        time < ramp,
        acceleration * time**2 / 2,
        np.where(
            time < total - ramp,
            rate * (time - ramp / 2),
            radians(200) - acceleration * (total - time) ** 2 / 2,
        ),
    )
    north_west_up = Rotation.from_euler(
        "x", angle.reshape(-1, 1)
    )  # x to the north, so y to the west
    force = north_west_up.inv().apply([0, 0, GRAVITY]).reshape(*angle.shape, 3).mean(axis=1)
    earth = [EARTH * cos(LATITUDE), 0, EARTH * sin(LATITUDE)]
    spin = north_west_up.inv().apply(earth).reshape(*angle.shape, 3).mean(axis=1)
    spin[:, 0] += speed.mean(axis=1)
    assert truth.force * 0.01 == pytest.approx(force * 0.01, abs=0.01 * ACCELEROMETER_COUNT)
    assert truth.rate * 0.01 == pytest.approx(spin * 0.01, abs=0.05 * GYRO_COUNT)


def test_rate_and_acceleration_are_the_derivatives_of_attitude_and_rate() -> None:
    """A case that rings about x while it turns about a leaning axis, by central differences."""
    instants = Instants(0.0, 400, 0.0005)
    t, unit = instants.elapsed, np.array([0.36, 0.48, 0.8])
    table = Turning(unit, 0.3 * t + t**2, 0.3 + 2 * t, np.full_like(t, 2), 1.0)
    f = 2 * pi * 20
    ringing = Turning(
        np.array([1.0, 0, 0]),
        0.05 * np.sin(f * t),
        0.05 * f * np.cos(f * t),
        -0.05 * f**2 * np.sin(f * t),
        1.0,
    )
    motion = move(instants, Rotation.from_euler("xyz", [1, 2, 3]).as_matrix(), [table, ringing])
    ends = Rotation.from_matrix(motion.attitude[::3])
    turned = (ends[:-1].inv() * ends[1:]).as_rotvec()
    # The integral of the rate is the rotation vector but for the coning within half a millisecond.
    assert motion.turned == pytest.approx(turned, abs=1e-8)
    assert np.abs(turned).max() > 3e-3
    change = instants.integral(motion.acceleration)
    assert motion.rate_change == pytest.approx(change, abs=1e-8)


@pytest.mark.parametrize(
    "profile",
    [
        Trapezoid(1.0, radians(-360), radians(10), radians(5)),
        Trapezoid(1.0, radians(3), radians(10), radians(5)),  # too small to reach its rate
        Change(radians(180), 20.0),
    ],
)
def test_a_profile_is_at_rest_at_both_ends_and_exact_in_angle(profile: Profile) -> None:
    time = np.linspace(0, 60, 60001)
    angle, rate, acceleration = profile.course(time)
    assert (angle[0], rate[0], rate[-1], acceleration[-1]) == (0, 0, 0, 0)
    assert angle[-1] == pytest.approx(profile.angle, abs=1e-14)
    assert np.abs(rate).max() == pytest.approx(profile.steady_rate, rel=1e-3)
    assert np.gradient(angle, time) == pytest.approx(rate, abs=1e-4)
    assert np.trapezoid(acceleration, time) == pytest.approx(0, abs=1e-4)


def test_logs_with_several_manoeuvres_go_without_a_jump_from_one_to_the_next(
    ideal: Callable[..., dict[str, object]],
) -> None:
    document = ideal(
        {"id": "a", "do": "rest", "up": "+z", "position": "one", "seconds": 5},
        {
            "id": "b",
            "do": "turn",
            "up": "+z",
            "position": "one",
            "degrees": 90,
            "rate_deg_s": 20,
            "accel_deg_s2": 20,
        },
        {"id": "c", "do": "rest", "up": "-x", "seconds": 5},
    )
    document["handling"] = {"still_s": 2, "change_s": 8}
    recording = perform(specify(document))
    truth = recording.truth["all.asc"]
    assert truth.rows == {"a": range(500), "b": range(500, 1450), "c": range(2250, 2750)}
    assert np.abs(np.diff(truth.force, axis=0)).max() < 0.04  # 0.4 rad/s × g × 0.01 s
    assert np.abs(np.diff(truth.rate, axis=0)).max() < 0.004
    assert truth.force[-1] == pytest.approx([-GRAVITY, 0, 0], abs=1e-12)
    assert truth.rate[:500] == pytest.approx(np.broadcast_to(truth.rate[0], (500, 3)), abs=1e-15)


def test_the_true_axis_stays_vertical_and_the_case_leans_against_it(
    ideal: Callable[..., dict[str, object]],
) -> None:
    """With position errors the horizontal accelerometers see the same force all the turn long."""
    document = ideal(
        {
            "id": "turn",
            "do": "turn",
            "up": "+z",
            "degrees": 360,
            "rate_deg_s": 20,
            "accel_deg_s2": 20,
        }
    )
    document["campaign"]["table"]["position_sigma_arcsec"] = 600  # type: ignore[index]
    truth = perform(specify(document)).truth["all.asc"]
    lean = np.hypot(*truth.force[0, :2]) / GRAVITY
    assert 1e-4 < lean < 2e-2
    assert truth.force == pytest.approx(np.broadcast_to(truth.force[0], truth.force.shape))


def test_position_errors_scatter_as_the_table_says(ideal: Callable[..., dict[str, object]]) -> None:
    """200 positions, two tilts each: chi-squared with 400 degrees of freedom."""
    plan = [
        {"id": f"p{k}", "do": "rest", "up": "+z", "seconds": 1, "log": "p.asc", "position": f"{k}"}
        for k in range(200)
    ]
    document = ideal(*plan)
    document["handling"] = {"still_s": 0, "change_s": 1}
    specification = specify(document)
    placements = place(
        specification.manoeuvres,
        heading=None,
        position_sigma=1e-5,
        leaning=lambda manoeuvre, attitude: np.eye(3),
        mountings={},
        of_axis=False,
        missed=lambda manoeuvre, attitude: np.eye(3),
        chance=specification.chance,
    )
    tilts = np.array([p.attitude.T @ [0, 0, 1] for p in placements.values()])[:, :2]
    assert 0.85 < np.sum((tilts / 1e-5) ** 2) / 400 < 1.15
    assert len({p.set_attitude[0, 0] for p in placements.values()}) == 200  # azimuths by chance


def test_normal_gravity_of_wgs84() -> None:
    """NIMA TR8350.2, table 3.4: at the equator and at the pole."""
    assert normal_gravity(0.0, 0.0) == pytest.approx(9.7803253359, abs=1e-10)
    assert normal_gravity(pi / 2, 0.0) == pytest.approx(9.8321849378, abs=1e-9)
    # design study, section 1: 9.793571 at 30 m above 30.53 degrees north
    assert normal_gravity(radians(30.53), 30.0) == pytest.approx(9.793571, abs=1e-6)
