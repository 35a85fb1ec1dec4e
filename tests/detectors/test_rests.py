"""Rests that are none: biases that jump, tables that move; and what must not be taken for it."""

import re

import numpy as np
import pytest
from recorded_by_hand import GRAVITY, INTERVAL, NOISE, given, log, piece, rest, stamps
from scipy.signal import lfilter

from inertial.detectors.bias_jump import BiasJump
from inertial.detectors.table_moving import TableMoving
from inertial.sensors import CHANNELS
from inertial.signal.detector import Event

ARC_SECOND = np.radians(1 / 3600)
N = 3000  # records: half a minute
K = 1200  # where something happens
FORCE = np.array([0.02, -0.01, GRAVITY])  # of the rest by hand, z up


def seen(values: np.ndarray, position: float = 2.0) -> list[tuple[str, Event]]:
    """What both detectors see in a rest; `position`: arc seconds, how well it was set."""
    one = piece(values, stamps(len(values)))
    known = log(one, given(position_sigma=position * ARC_SECOND))
    found = [(d, e) for d in (TableMoving(), BiasJump()) for e in d.detect(one, known)]
    for detector, event in found:
        words = detector.describe(event, "z-up")
        assert words.sentence.startswith("z-up:") and "nan" not in str(words)
    return [(detector.name, event) for detector, event in found]


def jumping(channel: int, sigmas: float, seed: int = 1, until: int = N) -> np.ndarray:
    values = rest(N, seed)
    values[K:until, channel] += sigmas * NOISE[channel]
    return values


def turning(rate: np.ndarray, seed: int = 1) -> np.ndarray:
    """A rest in which the case turns at small rates, (n, 3), rad/s: both sensors feel it."""
    values = rest(len(rate), seed)
    values[:, 3:] += rate
    values[:, :3] += np.cross(FORCE, np.cumsum(rate, axis=0) * INTERVAL)
    return values


def tilting(arc_seconds: float, first: int = 0, after: int = N, axis: int = 0) -> np.ndarray:
    rate = np.zeros((N, 3))
    rate[first:after, axis] = arc_seconds * ARC_SECOND / ((after - first) * INTERVAL)
    return turning(rate)


# ---- jumps


@pytest.mark.parametrize("channel", range(6), ids=CHANNELS)
@pytest.mark.parametrize("sigmas", [50, -10, 4])
def test_a_jump_is_found_to_within_two_records(channel, sigmas):
    for seed in range(10):
        ((name, event),) = seen(jumping(channel, sigmas, seed))
        assert (name, event.channel) == ("bias_jump", channel)
        assert abs(event.first - K) <= 2
        assert event.after == N
        # The noise stated by hand is that of S0; a step of 4 of its sigmas is known to 3 %.
        assert event.size / NOISE[channel] == pytest.approx(sigmas, abs=0.6)
        assert event.p_value < 1e-4


def test_a_jump_of_one_sigma_is_found_with_an_uncertain_place():
    number = inside = 0
    for seed in range(30):
        found = seen(jumping(seed % 6, 1, seed))
        assert {name for name, _ in found} <= {"bias_jump"}
        for _, event in found:
            number += 1
            off = K * INTERVAL - event.from_s
            inside += -event.facts.early - 1e-9 <= off <= event.facts.late + 1e-9
    assert number >= 28
    assert inside >= 0.85 * number  # 95 %


@pytest.mark.parametrize("walk", [1.0, 2.0, 4.0])
def test_a_bias_that_walks_does_not_jump(walk):
    """By 1, 2 and 4 sigma of a reading in 20 s: of some it can hardly be seen that they walk."""
    for seed in range(60):
        values = rest(2000, seed)
        steps = np.random.default_rng(seed).standard_normal(2000)
        values[:, 3] += walk * NOISE[3] * np.cumsum(steps) / np.sqrt(2000)
        assert "bias_jump" not in [name for name, _ in seen(values)]


def test_a_jump_that_goes_back_is_one_event():
    ((name, event),) = seen(jumping(1, 10, until=K + 150))
    assert name == "bias_jump"
    assert abs(event.first - K) <= 2 and abs(event.after - (K + 150)) <= 2
    words = BiasJump().describe(event, "z-up")
    assert "and back" in words.sentence
    assert event.facts.share == pytest.approx(0.05, abs=0.002)


def test_the_consequence_is_the_jump_times_its_share():
    ((_, event),) = seen(jumping(2, 10))
    words = BiasJump().describe(event, "z-up")
    # 10 × 1.07e-3 m/s² over 60 %; half of it is bias of the pair, and over 2 g ppm of scale.
    off = float(event.size) * 0.6
    assert off == pytest.approx(6.4e-3, rel=0.03)
    assert f"+{off:.5f} m/s²" in words.consequence and "60%" in words.consequence
    assert f"+{off / 2:.5f} m/s² of bias" in words.consequence
    assert f"+{off / 2 / GRAVITY * 1e6:.0f} ppm" in words.consequence


def test_two_jumps_of_a_channel_are_two_events():
    values = jumping(4, 20)
    values[2000:, 4] += 15 * NOISE[4]
    places = [event.first for _, event in seen(values)]
    assert places == pytest.approx([K, 2000], abs=2)


# ---- silence


def coloured(kind: str, seed: int) -> np.ndarray:
    generator = np.random.default_rng(seed)
    values, t = rest(N, seed), np.arange(N) * INTERVAL
    white = generator.standard_normal((N, 6))
    if kind == "random walk":  # K = 0.2 °/h/√h, and the accelerometers' 3e-4 m/s²/√h
        k = np.array([3e-4 / 60] * 3 + [np.radians(0.2 / 3600) / 60] * 3)
        values += np.cumsum(k * np.sqrt(INTERVAL) * white, axis=0)
    if kind == "flicker":
        values += (
            0.3
            * NOISE
            * sum(
                np.sqrt(1 - p**2) * lfilter([1], [1, -p], generator.standard_normal((N, 6)), axis=0)
                for p in (0.9, 0.99, 0.999)
            )
        )
    if kind == "excess noise":  # as S0's y axis, where it is level
        values[:, 1] += 6e-3 * white[:, 1]
    if kind == "oscillation":
        values[:, 3] += 0.01 * np.sin(2 * np.pi * 20 * t + seed)
        values[:, 0] += 0.02 * np.sin(2 * np.pi * 20 * t)
    if kind == "sway":
        values[:, 0] += 5e-3 * np.sin(2 * np.pi * 0.7 * t + seed)
    if kind == "settling":  # the bias just after a motion
        values += 30 * NOISE * np.exp(-t / (0.3 + seed % 5))[:, None]
    if kind == "drift":
        values += 10 * NOISE * (t / t[-1])[:, None]
    if kind == "spikes":
        values[generator.integers(0, N, 30), generator.integers(0, 6, 30)] += 0.5
    return values


KINDS = [
    "white",
    "random walk",
    "flicker",
    "excess noise",
    "oscillation",
    "sway",
    "settling",
    "drift",
    "spikes",
]


@pytest.mark.parametrize("seeds", [range(8), pytest.param(range(8, 25), marks=pytest.mark.slow)])
@pytest.mark.parametrize("kind", KINDS)
def test_noise_drift_and_settling_are_no_jump(kind, seeds):
    jumps = [
        (seed, event)
        for seed in seeds
        for name, event in seen(coloured(kind, seed))
        if name == "bias_jump"
    ]
    assert jumps == []


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind not in ("settling", "drift")])
def test_noise_is_no_motion(kind):
    assert all(not seen(coloured(kind, seed)) for seed in range(25))


# ---- motions


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("arc_seconds", [20, 100, 500])
def test_a_sudden_tilt_is_the_table_and_no_bias(arc_seconds, axis):
    ((name, event),) = seen(tilting(arc_seconds, K, K + 10, axis))
    assert name == "table_moving"
    assert event.size == pytest.approx(arc_seconds, rel=0.15)
    assert event.from_s == pytest.approx(K * INTERVAL, abs=1.1)
    assert event.to_s == pytest.approx(K * INTERVAL, abs=2.1)
    assert "the gyros turn along" in TableMoving().describe(event, "z-up").sentence


@pytest.mark.parametrize("arc_seconds", [50, 200, 2000])
def test_a_slow_creep_is_told_by_the_accelerometers(arc_seconds):
    ((name, event),) = seen(tilting(arc_seconds))
    assert (name, event.first, event.after) == ("table_moving", 0, N)
    assert event.size == pytest.approx(arc_seconds, rel=0.05, abs=3)
    assert "too slowly for the gyros" in TableMoving().describe(event, "z-up").sentence


@pytest.mark.parametrize("arc_seconds", [100, 1000])
def test_a_creep_that_begins_is_told_by_both(arc_seconds):
    ((name, event),) = seen(tilting(arc_seconds, 1500, N))
    assert name == "table_moving"
    assert event.size == pytest.approx(arc_seconds, rel=0.1)
    assert event.from_s == pytest.approx(15, abs=1.5)
    assert "the gyros turn along" in TableMoving().describe(event, "z-up").sentence


def test_what_only_the_accelerometers_show_and_the_gyros_deny_is_no_motion():
    values = rest(N)
    values[:, 0] += 5e-3 * (np.arange(N) / N) ** 2  # 105″, were it a tilt
    assert seen(values) == []


def test_a_warm_up_of_all_three_is_no_motion():
    values = rest(N)
    values[:, :3] += 5e-3 * (np.arange(N) / N)[:, None]
    assert seen(values) == []


@pytest.mark.parametrize("late", [0, 50, 100])
def test_biases_of_both_sensors_that_change_at_once_are_no_motion(late):
    values = rest(N, 2)
    values[K:, 0] += 5e-3  # m/s², as 105″ about y
    values[K + late :, 4] += -60 * ARC_SECOND  # rad/s, so within 2 s as much, and on
    assert all(name == "bias_jump" for name, _ in seen(values))


def test_a_creep_within_the_uncertainty_of_the_position_is_not_told():
    assert seen(tilting(500), position=3600) == []


def test_a_knock_is_told_and_is_no_jump():
    values = rest(N)
    knock = np.exp(-np.arange(40) / 15) * np.sin(np.arange(40) * 0.9)
    values[K : K + 40, 3] += 0.02 * knock
    values[K : K + 40, 1] += 0.5 * knock
    ((name, event),) = seen(values)
    assert name == "table_moving" and event.severity == 1
    assert "knocked" in TableMoving().describe(event, "z-up").sentence
    assert event.from_s == pytest.approx(K * INTERVAL, abs=0.2)


@pytest.mark.parametrize("swings", [0.0, 0.02])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_knock_after_which_the_case_stands_otherwise_is_a_tilt(axis, swings):
    """600 µg of it were "no fault" of the accelerometers: the knock hid the step that it left."""
    values = tilting(144.4, K, K + 10, axis)
    knock = np.random.default_rng(3).normal(size=(40, 3))
    values[K : K + 40, :3] += 0.3 * knock
    values[K : K + 40, 3 + axis] += swings * np.diff(knock[:, 0], prepend=0)
    ((name, event),) = seen(values)
    assert name == "table_moving" and event.severity is None
    assert event.size == pytest.approx(144.4, rel=0.05)
    assert "the gyros turn along" in TableMoving().describe(event, "z-up").sentence


@pytest.mark.parametrize("gyros", [True, False])
def test_a_tilt_of_two_seconds_is_confirmed_in_these_seconds(gyros):
    """Over the whole rest the noise of such gyros wanders by as much as they turn."""
    still, moved = rest(N), tilting(150, K, K + 150, 0)
    rng = np.random.default_rng(8)
    noise = np.hstack([9e-3 * rng.normal(size=(N, 3)), 4e-4 * rng.normal(size=(N, 3))])
    values = np.hstack([moved[:, :3], (moved if gyros else still)[:, 3:]]) + noise
    found = seen(values)
    assert [name for name, _ in found] == ["table_moving"] * gyros
    assert all(event.size == pytest.approx(150, rel=0.15) for _, event in found)


@pytest.mark.parametrize(
    ("lasts", "place", "told"),
    [(2, K + 1, "table_moving"), (10, K + 5, "table_moving"), (2, K + 300, "bias_jump")],
)
def test_a_step_of_an_accelerometer_at_a_spike_of_a_gyro_is_a_knock(lasts, place, told):
    """Three readings of a gyro were masked, and so was the turn that they measured."""
    values = tilting(144.4, K, K + lasts, 1)
    values[:, 3:] = rest(N)[:, 3:]
    values[place - 1 : place + 2, 4] = np.nan
    ((name, event),) = seen(values)
    assert name == told
    if told == "table_moving":
        assert event.size == pytest.approx(144.4, rel=0.05)
        assert "a knock" in TableMoving().describe(event, "z-up").sentence


def test_a_jump_of_a_level_gyro_is_told_from_a_turn():
    values = rest(N)
    values[K:, 3] += 10 * NOISE[3]  # turning so for 18 s, the case would tilt by 0.4°
    ((name, event),) = seen(values)
    assert (name, event.channel) == ("bias_jump", 3)
    turned = np.zeros((N, 3))
    turned[K:, 0] = 10 * NOISE[3]
    assert {name for name, _ in seen(turning(turned))} == {"table_moving"}


def test_a_jump_about_the_vertical_says_what_it_may_be_as_well():
    ((name, event),) = seen(jumping(5, 10))
    assert name == "bias_jump"
    assert (
        "about the vertical cannot be distinguished" in BiasJump().describe(event, "z-up").sentence
    )


def test_masked_readings_do_not_count():
    values = jumping(0, 10)
    values[K:, 0] = np.nan  # quality has masked them
    assert seen(values) == []


def test_a_rest_without_time_is_not_judged():
    values = jumping(0, 50)
    one = piece(values)
    known = log(one, given())
    assert not list(BiasJump().detect(one, known))
    assert not list(TableMoving().detect(one, known))


@pytest.mark.parametrize(("gyros", "severity", "said"), [(True, None, "gyros"), (False, 1, "")])
def test_of_a_rest_whose_attitude_nobody_states_none_is_off(gyros, severity, said):
    """Half of 0.5° is 900″: g (1 − cos 900″) = 0.093 mm/s² of the length of the mean force."""
    values = tilting(1800.0)
    if not gyros:
        values[:, 3:] = np.nan
    one = piece(values, stamps(N))
    known = log(one, given(position_sigma=30 * ARC_SECOND, attitude_set=False))
    (event,) = TableMoving().detect(one, known)
    assert event.severity == severity
    told = TableMoving().describe(event, "positions-03").consequence
    assert "stated uncertainty" not in told and "biases" not in told and said in told
    size, power = re.search(r"by (\S+)( × 10⁻⁵)? m/s²", told).groups()
    assert float(size) * (1e-5 if power else 1.0) == pytest.approx(9.3e-5, rel=0.1)
