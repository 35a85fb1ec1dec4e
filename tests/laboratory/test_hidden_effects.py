"""Every effect by the physics that it stands for, and every one absent when zero."""

from collections.abc import Callable
from math import pi, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from inertial.arrays import Array
from laboratory import Recording, perform, specify
from laboratory.checking import the_schema
from laboratory.effects import EFFECTS
from laboratory.faults import FAULTS
from tests.laboratory.at_zero_and_not import ALSO, AT_ZERO_AND_NOT, PLAN

GRAVITY, STANDARD, ARCSECOND = 9.7936174, 9.80665, radians(1 / 3600)
Performed = Callable[..., Recording]
REST = {"id": "still", "do": "rest", "up": "+z", "mark": "+x", "seconds": 20, "log": "rest.asc"}
TURN = {
    "id": "turn",
    "do": "turn",
    "up": "+z",
    "mark": "+x",
    "degrees": 360,
    "rate_deg_s": 40,
    "accel_deg_s2": 40,
    "log": "turn.asc",
}


def test_the_schema_and_these_tests_know_every_effect_and_fault() -> None:
    properties = the_schema()["properties"]
    assert set(properties["effects"]["properties"]) == set(EFFECTS) == set(AT_ZERO_AND_NOT)
    assert set(properties["faults"]["items"]["properties"]) == set(FAULTS)


@pytest.mark.parametrize("name", EFFECTS)
def test_zero_is_absent_and_anything_else_is_not(name: str, ideal: Callable[..., Any]) -> None:
    document = ideal(*PLAN, also=ALSO)
    absent = written(document)
    zero, other = (written(document | {"effects": {name: p}}) for p in AT_ZERO_AND_NOT[name])
    assert zero == absent
    assert other != absent


@pytest.mark.slow
def test_all_of_them_at_once_are_the_same_at_every_performance(ideal: Callable[..., Any]) -> None:
    """Effects that remember begin anew, and those that draw have a stream of their own."""
    every = {name: other for name, (_, other) in AT_ZERO_AND_NOT.items()}
    specification = specify(ideal(*PLAN, also=ALSO | {"effects": every}))
    once, again = perform(specification), perform(specification)
    assert once.logs == again.logs
    readings = [once.truth[log].noisy for log in once.records]
    assert all(np.isfinite(reading.gyro).all() for reading in readings)
    assert all(np.isfinite(reading.accelerometer).all() for reading in readings)


def written(document: dict[str, Any]) -> dict[str, tuple[bytes, bytes]]:
    """Stamps and counts of every log."""
    records = perform(specify(document)).records
    return {log: (one.stamps.tobytes(), one.counts.tobytes()) for log, one in records.items()}


def test_a_lever_arm_feels_the_centripetal_and_the_tangential_force(performed: Performed) -> None:
    """ω² r towards the axis, ω′ r along the path, and after a turn no velocity from the latter."""
    truth = performed(TURN, effects={"lever_arm": {"arm_m": [0.05, 0, 0.03]}}).truth["turn.asc"]
    steady, spin_up = truth.force[1150:1800], truth.force[1000:1100]
    assert steady[:, 0] == pytest.approx(-(radians(40) ** 2) * 0.05, abs=1e-12)
    assert steady[:, 1:] == pytest.approx(np.broadcast_to([0, GRAVITY], (650, 2)), abs=1e-12)
    assert spin_up[:, 1] == pytest.approx(radians(40) * 0.05, abs=1e-12)
    assert truth.force[:, 1].sum() == pytest.approx(0, abs=1e-12)


def test_a_tilted_table_leans_towards_north_and_east(performed: Performed) -> None:
    """x to the north, y to the west. The case's up leans north: gravity's reaction falls behind."""
    tilt = {"north_arcsec": 60, "east_arcsec": 20}
    recording = performed(REST, TURN, effects={"table_tilt": tilt})
    force = recording.truth["rest.asc"].force.mean(axis=0)
    expected = GRAVITY * ARCSECOND * np.array([-60, 20])
    assert force[:2] == pytest.approx(expected, abs=GRAVITY * (1e-3) ** 2)
    # The direction of the lean stays in the room while the case turns: half a turn, other sign.
    turning = recording.truth["turn.asc"]
    half = len(turning.time) // 2
    assert turning.force[half - 1 : half + 1, :2].mean(axis=0) == pytest.approx(-expected, abs=1e-5)


def test_gyros_that_feel_force(performed: Performed) -> None:
    matrix = [[1.4, 0, 3.0], [0, -1.0, 0], [0.5, 0, 1.2]]
    effects = {"gyro_g_sensitivity": {"matrix_deg_h_g": matrix}}
    truth = performed(REST, effects=effects).truth["rest.asc"]
    added = np.diff(truth.noiseless.gyro, axis=0) / 0.01 - truth.rate[1:]
    expected = radians(1 / 3600) * GRAVITY / STANDARD * np.array([3.0, 0, 1.2])
    assert added == pytest.approx(np.broadcast_to(expected, added.shape), abs=1e-12)


def test_ramps_run_on_through_the_pause(performed: Performed) -> None:
    """t counts from the campaign's first sample, which stands at the end of its interval."""
    effects = {
        "gyro_bias_ramp": {"ramp_deg_h_h": [1, -2, 3]},
        "accel_bias_ramp": {"ramp_m_s2_h": [0.01, 0, -0.02]},
    }
    recording = performed(REST, REST | {"id": "b", "log": "b.asc"}, effects=effects)
    truth = recording.truth["b.asc"]
    assert truth.time[0] == pytest.approx(19.99 + 60)
    middle = (truth.time[1:] - 0.005)[:, None]
    gyro = np.diff(truth.noiseless.gyro, axis=0) / 0.01 - truth.rate[1:]
    assert gyro == pytest.approx(middle * radians(1) / 3600**2 * [1, -2, 3], abs=1e-12)
    force = np.diff(truth.noiseless.accelerometer, axis=0) / 0.01 - truth.force[1:]
    assert force == pytest.approx(middle / 3600 * [0.01, 0, -0.02], abs=1e-10)


@pytest.mark.parametrize("up", ["+z", "-z"])
def test_a_quadratic_accelerometer_errs_upwards_both_ways_up(performed: Performed, up: str) -> None:
    effects = {"accel_quadratic": {"k2_micro_g_g2": [50, 60, 70]}}
    truth = performed(REST | {"up": up}, effects=effects).truth["rest.asc"]
    added = truth.noiseless.accelerometer[-1] / 20 - truth.force.mean(axis=0)
    expected = 70e-6 * STANDARD * (GRAVITY / STANDARD) ** 2
    assert added == pytest.approx([0, 0, expected], abs=1e-9)


def test_an_oscillation_rings_only_while_turning_and_adds_no_angle(performed: Performed) -> None:
    """0.01 rad/s at 20 Hz about x: one line in the spectrum, none at rest, no angle in the end."""
    effects = {"oscillation": {"frequency_hz": 20, "amplitude_rad_s": 0.01, "axis": "+x"}}
    with_it = performed(REST, TURN, effects=effects)
    without = performed(REST, TURN)
    assert with_it.logs["rest.asc"] == without.logs["rest.asc"]
    rung = with_it.truth["turn.asc"].rate - without.truth["turn.asc"].rate
    assert np.abs(rung[:1000]).max() < 1e-15
    assert np.abs(rung[-1000:]).max() < 1e-15
    steady = rung[1150:1650, 0]  # 5 s
    spectrum = np.abs(np.fft.rfft(steady)) * 2 / len(steady)
    # A sample is a mean over 0.01 s: the amplitude shrinks by sinc(f dt).
    assert spectrum[100] == pytest.approx(0.01 * np.sinc(20 * 0.01), rel=1e-5)
    assert np.delete(spectrum, 100).max() < 1e-7
    assert rung[:, 0].sum() * 0.01 == pytest.approx(0, abs=1e-12)
    # It is a motion: as the case rocks about x, gravity swings on y by g A / (2πf).
    swing = with_it.truth["turn.asc"].force[1150:1650, 1]
    amplitude = np.sqrt(2 * np.mean(swing**2)) / np.sinc(20 * 0.01)
    assert amplitude == pytest.approx(GRAVITY * 0.01 / (2 * pi * 20), rel=1e-4)


def test_a_drive_that_keeps_itself_in_motion_follows_its_equation(performed: Performed) -> None:
    """van der Pol's, integrated here until only its limit cycle is left; two of its harmonics."""
    nonlinearity, steps = 0.3, 1000

    def equation(_: float, x: Array) -> list[float]:
        return [x[1], nonlinearity * (1 - x[0] ** 2) * x[1] - x[0]]

    solved = solve_ivp(equation, (0, 300), [2, 0], rtol=1e-9, atol=1e-9, dense_output=True)
    upwards = [brentq(lambda t: solved.sol(t)[0], t, t + 1) for t in crossings(solved.sol)]
    cycle = solved.sol(np.linspace(*upwards[-2:], steps, endpoint=False))[0]
    harmonics = np.fft.rfft(cycle)
    ringing = {
        "frequency_hz": 2,
        "amplitude_rad_s": 0.01,
        "axis": "+x",
        "nonlinearity": nonlinearity,
    }
    with_it = performed(REST, TURN, effects={"oscillation": ringing}).truth["turn.asc"]
    rung = (with_it.rate - performed(REST, TURN).truth["turn.asc"].rate)[1150:1650, 0]
    spectrum = np.fft.rfft(rung) / np.sinc(np.arange(251) / 5 * 0.01)
    assert 2 * np.abs(spectrum[10]) / 500 == pytest.approx(0.01, rel=1e-4)
    shares = [
        h[3 * n] / h[n] * (abs(h[n]) / h[n]) ** 2 for h, n in ((harmonics, 1), (spectrum, 10))
    ]
    # Of a rate, which is 3i to i times the angle; the second order of ε is a tenth here.
    assert shares[1] / -3 == pytest.approx(shares[0], abs=0.15 * abs(shares[0]))


def crossings(solution: Callable[[Array], Array]) -> Array:
    """Times of a grid after which a solution becomes positive, of its last few periods."""
    times = np.arange(280, 300, 1.0)
    upward = np.diff(np.sign(solution(times)[0])) > 0
    return times[:-1][upward]


def test_a_table_that_creeps_is_felt_by_gyros_and_accelerometers(performed: Performed) -> None:
    """100 deg/h about east for 10 s, 1000″: x, which points north, rises and sees g sin of it."""
    creep = {"about": "east", "rate_deg_h": 100, "from_s": 5, "to_s": 15}
    recording = performed(REST, TURN, effects={"table_creep": creep})
    truth, without = recording.truth["rest.asc"], performed(REST, TURN).truth["rest.asc"]
    felt = truth.rate - without.rate
    assert felt[501:1500, 1] == pytest.approx(-radians(100 / 3600), abs=1e-6)  # y points west
    assert felt.sum(axis=0)[1] * 0.01 == pytest.approx(-1000 * ARCSECOND, rel=2e-4)
    assert np.abs(felt[:500]).max() == 0
    lean = np.clip(truth.time - 0.005 - 5, 0, 10) * radians(100 / 3600)
    assert truth.force[:, 0] == pytest.approx(GRAVITY * np.sin(lean), abs=1e-8)
    assert truth.force[:, 1] == pytest.approx(0, abs=1e-12)
    assert truth.force[-1, 0] == pytest.approx(GRAVITY * sin(1000 * ARCSECOND), abs=1e-12)


def test_a_table_that_has_crept_leans_from_then_on(performed: Performed) -> None:
    """The turn after it is that on a table whose vertical leans by as much towards south."""
    creep = {"about": "east", "rate_deg_h": 60, "from_s": 1, "to_s": 2}
    crept = performed(REST, TURN, effects={"table_creep": creep}).truth["turn.asc"]
    tilt = {"north_arcsec": -60, "east_arcsec": 0}
    leaning = performed(REST, TURN, effects={"table_tilt": tilt}).truth["turn.asc"]
    assert crept.force == pytest.approx(leaning.force, abs=1e-12)
    assert crept.rate == pytest.approx(leaning.rate, abs=1e-15)


def test_a_creep_during_a_turn_adds_to_it(performed: Performed) -> None:
    """About the axis of the turn for all its 30 s, which begin 60 s after the rest of 20 s."""
    creep = {"about": "up", "rate_deg_h": 100, "from_s": 79, "to_s": 200}
    ringing = {"frequency_hz": 20, "amplitude_rad_s": 0.01, "axis": "+x"}
    effects = {"oscillation": ringing}
    crept = performed(REST, TURN, effects={**effects, "table_creep": creep}).truth["turn.asc"]
    without = performed(REST, TURN, effects=effects).truth["turn.asc"]
    added = (crept.rate - without.rate).sum(axis=0)[2] * 0.01
    assert added == pytest.approx(30 * radians(100 / 3600), rel=1e-6)
    assert crept.force == pytest.approx(without.force, abs=1e-12)


def test_a_creep_shakes_a_lever_arm_where_it_begins_and_ends(performed: Performed) -> None:
    """1 deg/s at 5 cm: the velocity along the path comes at once, and goes at once."""
    creep = {"about": "up", "rate_deg_h": 3600, "from_s": 5, "to_s": 15}
    effects = {"table_creep": creep, "lever_arm": {"arm_m": [0.05, 0, 0]}}
    force = performed(REST, effects=effects).truth["rest.asc"].force[:, 1]
    velocity = radians(1) * 0.05
    assert force[498:503].sum() * 0.01 == pytest.approx(velocity, rel=1e-6)
    assert force[1498:1503].sum() * 0.01 == pytest.approx(-velocity, rel=1e-6)
    assert force[503:1498] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(("up", "north", "east"), [("+z", 0, 1), ("+y", 0, 2)])
def test_a_table_that_sways_is_seen_by_the_level_axes_alone(
    performed: Performed, up: str, north: int, east: int
) -> None:
    """N √dt over every 10 ms, as much as S0's y axis and a third of it; 5 sigma of 2000 each."""
    rest = REST | {"up": up, "mark": "+x"}
    truth = performed(rest, table_sway_m_s_sqrt_h=[0.05, 0.015]).truth["rest.asc"]
    noise = np.diff(truth.noisy.accelerometer - truth.noiseless.accelerometer, axis=0) / 0.01
    bar = 5 / sqrt(2 * 2000)
    assert np.std(noise[:, east]) == pytest.approx(0.05 / 60 / sqrt(0.01), rel=bar)  # 8 mm/s²
    assert np.std(noise[:, north]) == pytest.approx(0.015 / 60 / sqrt(0.01), rel=bar)
    assert np.abs(noise[:, 3 - north - east]).max() < 1e-12
    follow = np.corrcoef(noise[1:, east], noise[:-1, east])[0, 1]
    assert abs(follow) < 5 / sqrt(2000)
    assert np.array_equal(truth.noisy.gyro, truth.noiseless.gyro)
