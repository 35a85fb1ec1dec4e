"""Signs and axes of the gyros, from gravity that turns in the accelerometers, moved by hand."""

from itertools import permutations, product

import chain
import numpy as np
import pytest
from diagnosis.test_real_recordings import campaign, columns
from moved_by_hand import TWENTY_FOUR, attitudes, by_hand

from inertial.signal.axis_permutations import AS_NAMED, Permutation
from inertial.signal.gravity_turned import MAX_ARM, turned

GRAVITY, RATE, FINE = 9.81, 100, 10
BIAS = np.array([4.0, -1.0, 6.0])  # m/s², 0.75 g


def moved(seed, positions=12, jerk=0.5, *, sudden=False):
    """An IMU put down in one attitude after another: forces and rates at 100 Hz, (n, 3) each.

    `jerk`: m/s², of the hand, while it moves; `sudden`: it changes from record to record.
    """
    rng = np.random.default_rng(seed)
    stands = attitudes(rng, TWENTY_FOUR[rng.permutation(24)[:positions]], 0.1)
    forces, rates = [], []
    for here, there in zip(stands, [*stands[1:], None], strict=True):
        still = 2 * RATE
        forces.append(np.tile(GRAVITY * here.inv().apply([0, 0, 1]), (still, 1)))
        rates.append(np.zeros((still, 3)))
        if there is not None:
            way = by_hand(rng, here, there)
            steps = (way[:-1].inv() * way[1:]).as_rotvec() * RATE * FINE
            rates.append(steps.reshape(-1, FINE, 3).mean(axis=1))
            up = way[FINE // 2 :: FINE].inv().apply([0, 0, 1])
            # What a hand presses with changes within tenths of a second.
            pressed = rng.standard_normal((len(up) // 20 + 2, 3))
            pressed[[0, -1]] = 0.0
            nodes = np.linspace(0, len(up), len(pressed))
            at = np.arange(len(up)) // 20 * 20 if sudden else np.arange(len(up))
            shaken = [np.interp(at, nodes, column) for column in pressed.T]
            forces.append(GRAVITY * up + jerk * np.transpose(shaken))
    noise = rng.standard_normal((2, sum(map(len, forces)), 3))
    return np.concatenate(forces) + 0.02 * noise[0], np.concatenate(rates) + 0.003 * noise[1]


def in_bins(values):
    return values[: len(values) // 10 * 10].reshape(-1, 10, 3).mean(axis=1)


def seen(forces, rates):
    return turned([(in_bins(forces), in_bins(rates), 0.1)])


def matrix(axes):
    made = np.zeros((3, 3))
    made[range(3), axes.sources] = axes.signs
    return made


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [0.76, 1.0, 1.3])
def test_whatever_bias_and_scale_the_axes_are_those_that_are(seed, scale):
    """A bias of 0.75 g, a level of 9 °/s, and gyros that read a quarter too little or too much."""
    forces, rates = moved(seed)
    found = seen(forces + BIAS, scale * rates + [0.15, -0.1, 0.05])
    assert found.axes == AS_NAMED
    # In a bin of 0.1 s the hand turns it by up to 20°, so G is off by a sixth.
    assert np.abs(found.matrix - np.eye(3) / scale).max() < 0.2


@pytest.mark.parametrize("seed", range(3))
def test_an_axis_that_is_reversed_for_a_time_is_no_reversed_axis(seed):
    """Two thirds of what turns it read the other way: neither sign is that of the recording."""
    forces, rates = moved(seed, positions=20)
    rates[len(rates) // 3 :, 2] *= -1
    found = seen(forces, rates)
    assert found.axes is None
    assert found.contradicting[2] > 0.2


@pytest.mark.parametrize("sources", list(permutations(range(3))))
def test_every_exchange_and_every_sign_is_found(sources):
    forces, rates = moved(7)
    for signs in product((1, -1), repeat=3):
        axes = Permutation(sources, signs)
        found = seen(forces, rates @ matrix(axes))  # so that matrix(axes) @ reading is the rate
        assert found.axes == axes


def test_accelerometers_that_tell_gravity_turn_alike():
    """All three reversed: no motion shows it. One of them: as if both other gyros were."""
    forces, rates = moved(3)
    assert seen(-forces, rates).axes == AS_NAMED
    assert seen(forces * [1, 1, -1], rates).axes == Permutation((0, 1, 2), (-1, -1, 1))


def test_a_turn_about_the_vertical_tells_nothing():
    rates = np.zeros((6000, 3))
    rates[1000:5000, 2] = 0.5
    forces = np.tile([0.0, 0.0, GRAVITY], (6000, 1))
    noise = np.random.default_rng(1).standard_normal((2, 6000, 3))
    found = seen(forces + 0.01 * noise[0], rates + 0.001 * noise[1])
    assert found is None or found.axes is None


@pytest.mark.parametrize(("acceleration", "still"), [(300.0, 2.0), (400.0, 2.2)])
def test_the_pull_of_a_lever_arm_in_turns_about_the_vertical_tells_nothing(acceleration, still):
    """To 300 °/s and back, four times about each axis: it read as three reversed gyros."""
    arm, rng, ramp = np.array([0.06, 0.02, -0.03]), np.random.default_rng(3), 300.0 / acceleration
    time = np.arange(round((12 + 2 * still + 2 * ramp) * RATE)) / RATE
    spun = np.clip(np.minimum(time - still, time[-1] - still - time), 0.0, ramp)
    stretches = []
    for number in range(12):
        axis = np.eye(3)[number % 3]
        rates = np.outer(np.radians(acceleration) * spun, axis)
        forces = GRAVITY * axis * (1 if number < 6 else -1) + np.cross(rates, np.cross(rates, arm))
        forces += np.cross(np.gradient(rates, axis=0) * RATE, arm)
        noise = rng.standard_normal((2, *rates.shape))
        read = in_bins(forces + 0.001 * noise[0]), in_bins(rates + 1e-5 * noise[1])
        stretches.append((*read, 0.1))
    found = turned(stretches, MAX_ARM)
    assert found is None or found.axes is None


def test_shaking_without_turning_tells_nothing():
    rng = np.random.default_rng(2)
    forces = [0, 0, GRAVITY] + 3 * rng.standard_normal((6000, 3))
    found = seen(forces, 0.3 * rng.standard_normal((6000, 3)))
    assert found is None or found.axes is None


def by_hand_campaign(tmp_path, forces, rates, **more):
    raw = tmp_path / "raw"
    raw.mkdir()
    np.savetxt(raw / "log.csv", np.hstack([forces, rates]), fmt="%.6f", delimiter=",")
    form = columns(
        delimiter=",",
        accelerometer={"columns": [1, 2, 3], "unit": "m/s2"},
        gyro={"columns": [4, 5, 6], "unit": "rad/s"},
    )
    plan = [{"id": "by-hand", "do": "positions", "seconds": 1}]
    campaign(raw, {"name": "own", "rate_hz": 100, "format": form}, plan, log="log.csv", **more)
    return chain.run(raw, tmp_path / "derived", "segment")


@pytest.mark.parametrize("seed", [11, 12, 16, 18, 19])
def test_a_hand_that_jerks_exchanges_no_axes(tmp_path, seed):
    results = by_hand_campaign(tmp_path, *moved(seed, jerk=1.0, sudden=True))
    for stage in ("quality", "segment"):
        assert not results[f"{stage}/findings"]["cause"].isin(["axis_swap", "sign_flip"]).any()


def test_a_reversed_gyro_is_set_right_without_any_attitude(tmp_path):
    forces, rates = moved(11)
    results = by_hand_campaign(tmp_path, forces, rates * [-1, 1, 1])
    (repair,) = results["segment/repairs"].itertuples()
    assert (repair.id, repair.state, repair.sensor) == ("signs/gyro/by-gravity", "applied", "gyro")
    channels = results["segment/channel_repairs"].set_index("axis")
    assert channels["factor"].to_dict() == {"x": -1.0, "y": 1.0, "z": 1.0}
    (found,) = results["segment/findings"].query("cause == 'sign_flip'").itertuples()
    assert "x reads −x" in found.sentence and "left-handed" in found.sentence
    assert repair.finding == found.id


def test_two_reversed_gyros_may_be_one_reversed_accelerometer(tmp_path):
    forces, rates = moved(12)
    results = by_hand_campaign(tmp_path, forces, rates * [-1, 1, -1])
    repairs = results["segment/repairs"].set_index("id")
    assert set(repairs.index) == {"signs/gyro/by-gravity", "signs/accel/by-gravity"}
    assert set(repairs["state"]) == {"rival"} and results["segment/channel_repairs"].empty
    assert repairs.loc["signs/accel/by-gravity", "condition"].endswith("y reads −y")


def test_the_laboratory_says_which_of_them(tmp_path):
    forces, rates = moved(12)
    accept = ["signs/accel/by-gravity"]
    results = by_hand_campaign(tmp_path, forces * [1, -1, 1], rates, accept=accept)
    (repair,) = results["segment/repairs"].itertuples()
    assert (repair.id, repair.state) == ("signs/accel/by-gravity", "confirmed")
    channels = results["segment/channel_repairs"].set_index("axis")
    assert channels["factor"].to_dict() == {"x": 1.0, "y": -1.0, "z": 1.0}


def test_nothing_is_said_of_an_imu_that_is_right(tmp_path):
    forces, rates = moved(13)
    results = by_hand_campaign(tmp_path, forces + BIAS, 0.76 * rates)
    assert results["segment/repairs"].empty and results["segment/findings"].empty
