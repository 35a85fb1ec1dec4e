"""A chamber: its air, the IMU and its parts behind it, and biases along the temperature."""

from collections.abc import Callable
from math import exp, radians
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from laboratory import Recording, perform, specify

Document = dict[str, Any]
Ideal = Callable[..., Document]

ICE, MICRO_G, DEG_H = 273.15, 9.80665e-6, radians(1 / 3600)
STEPS = [
    {"hold_s": 120},
    {"to_deg_c": 50, "rate_k_min": 6},
    {"hold_s": 600},
    {"to_deg_c": 35, "rate_k_min": 3},
    {"hold_s": 400},
]
CORNERS, AIR = [0, 120, 420, 1020, 1320], [20, 20, 50, 50, 35]  # s, °C: the same by hand


def recorded(ideal: Ideal, *seconds: float, pause: float = 1, **sections: Any) -> Recording:
    """Rests one after another, each in a log of its own, 2 samples a second."""
    plan = [
        {"id": f"rest-{k}", "do": "rest", "up": "+z", "mark": "+x", "seconds": s, "log": f"{k}"}
        for k, s in enumerate(seconds)
    ]
    document = ideal(*plan, also=sections)
    document["receiver"] |= {"rate_hz": 2}
    document["start"] |= {"pause_s": pause}
    return perform(specify(document))


def chamber(constant: float = 90.0, steps: Any = None, **more: Any) -> Document:
    return {
        "start_deg_c": 20,
        "chamber": {"steps": steps or STEPS, "time_constant_s": constant},
    } | more


def added(recording: Recording, log: str, sensor: str) -> Any:
    """Reading less truth, (n − 1, 3), and the temperature, °C, in the middle, (n − 1,)."""
    truth = recording.truth[log]
    true = {"gyro": truth.rate, "accelerometer": truth.force}[sensor]
    middle = (truth.temperature[1:] + truth.temperature[:-1]) / 2 - ICE
    return np.diff(getattr(truth.noisy, sensor), axis=0) / 0.5 - true[1:], middle


@pytest.mark.parametrize("lag", [0, 30, 90, 300])
def test_imu_and_thermometer_follow_the_air(ideal: Ideal, lag: float) -> None:
    """As the differential equations of two bodies behind the air give it, also where τ = λ."""
    truth = recorded(ideal, 1700, temperature=chamber(thermometer={"lag_s": lag, "above_k": 2}))
    truth = truth.truth["0"]

    def flow(time: float, kelvin: Any) -> Any:
        air, imu = np.interp(time, CORNERS, AIR), kelvin[0]
        return [(air - imu) / 90, (imu - kelvin[1]) / (lag or 1)]

    course = solve_ivp(
        flow, [0, 1700], [20, 20], t_eval=truth.time, rtol=1e-9, atol=1e-9, max_step=5
    )
    assert truth.temperature - ICE == pytest.approx(course.y[1 if lag else 0] + 2, abs=1e-5)


def test_a_ramp_leaves_the_parts_behind_by_rate_times_lag(ideal: Ideal) -> None:
    """10 min into a ramp of 3 K/min: air 50 °C, IMU by 60 s behind, gyros by 20 s more."""
    temperature = chamber(
        60,
        [{"to_deg_c": 80, "rate_k_min": 3}],
        gyro={"lag_s": 20},
        accelerometer={"lag_s": 5, "above_k": 1},
        thermometer={"lag_s": 40},
    )
    effects = {
        "gyro_bias_temperature": {"k_deg_h_k": [0, 0, 1]},
        "accel_bias_temperature": {"k_micro_g_k": [0, 0, 1]},
    }
    recording = recorded(ideal, 700, temperature=temperature, effects=effects)
    at = 1200
    assert recording.truth["0"].temperature[at] - ICE == pytest.approx(50 - 5, abs=0.01)
    gyro, accelerometer = (added(recording, "0", s)[0][at, 2] for s in ("gyro", "accelerometer"))
    assert gyro / DEG_H == pytest.approx(30 - 4, abs=0.03)
    assert accelerometer / MICRO_G == pytest.approx(30 - 3.25 + 1, abs=0.03)


def test_soaks_lie_in_the_pauses_between_logs(ideal: Ideal) -> None:
    recording = recorded(ideal, 100, 100, pause=700, temperature=chamber())
    first, second = (recording.truth[log].temperature[-1] - ICE for log in "01")
    assert first == pytest.approx(20)
    assert second == pytest.approx(50 - 9 * exp(-480 / 90) * (1 - exp(-300 / 90)), abs=0.01)


def test_curves_bend_biases_and_elements(ideal: Ideal) -> None:
    """A cubic in the gyro's bias, a knee in the accelerometer's, and a cross term."""
    effects = {
        "temperature_curves": {
            "gyro": {"bias_deg_h": {"x": {"powers": [1, -0.5, 0.02]}}},
            "accelerometer": {
                "bias_micro_g": {"z": {"knee_deg_c": 30, "below": -10, "above": 40}},
                "matrix_ppm": {"xz": {"powers": [2]}, "zz": {"powers": [0, 1]}},
            },
        }
    }
    temperature = chamber(0.0, [{"to_deg_c": 50, "rate_k_min": 10}], reference_deg_c=25)
    recording = recorded(ideal, 180, temperature=temperature, effects=effects)
    off, at = added(recording, "0", "gyro")
    warmer = at - 25
    assert off[:, 0] / DEG_H == pytest.approx(
        warmer - 0.5 * warmer**2 + 0.02 * warmer**3, abs=0.005
    )
    assert np.abs(off[:, 1:]).max() < 1e-12
    off, at = added(recording, "0", "accelerometer")
    g = recording.truth["0"].force[0, 2]
    knee = np.where(at < 30, -10 * (at - 25), -50 + 40 * (at - 30)) * MICRO_G
    assert off[:, 0] == pytest.approx(2e-6 * g * warmer, abs=1e-9)
    assert off[:, 2] == pytest.approx(knee + 1e-6 * g * warmer**2, abs=0.5 * MICRO_G)


LOOP = [{"to_deg_c": c, "rate_k_min": 20} for c in (50, 10, 50, 10)]
HYSTERESIS = {"temperature_hysteresis": {"gyro_deg_h": [0, 0, 3], "half_width_k": 4}}


def test_a_cycle_encloses_the_area_of_the_loop(ideal: Ideal) -> None:
    """2 h (R − 2 w) over 40 K: 2 · 3 deg/h · 32 K; nothing on the other axes."""
    recording = recorded(ideal, 450, temperature=chamber(0, LOOP), effects=HYSTERESIS)
    off, at = added(recording, "0", "gyro")
    cycle = slice(420, 901)  # from 10 °C at 210 s … to 50 °C and back to 10 °C at 450 s
    area = np.sum((off[cycle][1:, 2] + off[cycle][:-1, 2]) / 2 * np.diff(at[cycle])) / DEG_H
    assert area == pytest.approx(2 * 3 * (40 - 2 * 4), rel=0.005)
    assert off[cycle, 2].max() / DEG_H == pytest.approx(3)
    assert np.abs(off[:, :2]).max() < 1e-12


def test_a_reversal_in_a_pause_is_remembered(ideal: Ideal) -> None:
    """From 40 °C in the first log through 50 °C to 40 °C in the second: after cooling."""
    temperature = chamber(0, LOOP)
    recording = recorded(ideal, 60, 30, pause=60, temperature=temperature, effects=HYSTERESIS)
    off, at = added(recording, "1", "gyro")
    assert at[0] == pytest.approx(40, abs=0.5)
    assert off[0, 2] / DEG_H == pytest.approx(-3)
    assert added(recording, "0", "gyro")[0][-1, 2] / DEG_H == pytest.approx(3)
