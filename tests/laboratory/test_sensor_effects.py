"""What effects add to the readings, against numbers reckoned by hand."""

from collections.abc import Callable
from math import cos, exp, radians, sin, sqrt
from typing import Any

import numpy as np
import pytest

from laboratory import Recording, perform, specify

Performed = Callable[..., Recording]
Document = dict[str, Any]

GRAVITY, STANDARD, MICRO_G = 9.7936174, 9.80665, 9.80665e-6
DEG_H, EARTH = radians(1 / 3600), 7.292115e-5
NORTH, UP = EARTH * cos(radians(30.5278)), EARTH * sin(radians(30.5278))  # what x and z feel
G = GRAVITY / STANDARD
WARM = {"temperature": {"start_deg_c": 30, "reference_deg_c": 20}}


def rest(up: Any = "+z", name: str = "still", seconds: float = 4) -> Document:
    """Up as said; x, or y where x is up, to the north."""
    mark = "+y" if up in ("+x", "-x") else "+x"
    return {"id": name, "do": "rest", "up": up, "mark": mark, "seconds": seconds, "log": name}


def turn(rate: float, up: str = "+z") -> Document:
    """A turn about the axis that is upright, by twice the rate in degrees."""
    return rest(up) | {"do": "turn", "degrees": 4 * rate, "accel_deg_s2": abs(rate)}


def added(performed: Performed, name: str, parameters: Document, move: Document) -> Any:
    """What an effect adds to the mean reading of one manoeuvre: accelerometers, gyros; (3,) each.

    Of a turn: at its steady rate, from 1.2 s after its start to 1.2 s before its end.
    """
    if move["do"] == "turn":
        move = move | {"rate_deg_s": abs(move["degrees"] / 4)}
        del move["seconds"]
    also = WARM | {"handling": {"still_s": 1}}
    means = []
    for effects in ({name: parameters}, {}):
        (truth,) = performed(move, effects=effects, also=also).truth.values()
        inside = slice(220, -220) if move["do"] == "turn" else slice(None)
        readings = (truth.noisy.accelerometer, truth.noisy.gyro)
        means.append([np.diff(sums, axis=0)[inside].mean(axis=0) / 0.01 for sums in readings])
    return np.array(means[0]) - means[1]


Z10, Z40 = radians(10) + UP, radians(40) + UP  # rad/s: what the z gyro feels at 10 and 40 deg/s
BY_HAND: list[tuple[str, Document, Document, list[float], list[float]]] = [
    # 3 deg/h/g² at (g/9.80665)², upright or head over heels
    ("gyro_g2_sensitivity", {"k_deg_h_g2": [1, 2, 3]}, rest(), [0] * 3, [0, 0, 3 * G**2 * DEG_H]),
    (
        "gyro_g2_sensitivity",
        {"k_deg_h_g2": [1, 2, 3]},
        rest("-z"),
        [0] * 3,
        [0, 0, 3 * G**2 * DEG_H],
    ),
    # 1 ppm/(deg/s) at 10 deg/s: 10 ppm, and the same scale factor backward
    (
        "gyro_scale_quadratic",
        {"k2_ppm_per_deg_s": [0, 0, 1]},
        turn(10),
        [0] * 3,
        [0, 0, 10e-6 * (1 + 2 * UP / radians(10)) * radians(10)],
    ),
    (
        "gyro_scale_quadratic",
        {"k2_ppm_per_deg_s": [0, 0, 1]},
        turn(-10),
        [0] * 3,
        [0, 0, -10e-6 * (1 - 2 * UP / radians(10)) * radians(10)],
    ),
    # 0.01 ppm/(deg/s)² at 40 deg/s: 16 ppm
    (
        "gyro_scale_cubic",
        {"k3_ppm_per_deg_s_2": [0, 0, 0.01]},
        turn(40),
        [0] * 3,
        [0, 0, 16e-6 * radians(40) * (1 + 3 * UP / radians(40))],
    ),
    # 2 deg/h at 10 deg/s, eight times as much at 40 deg/s, backward as forward
    (
        "gyro_rate_power",
        {"at_10_deg_s_deg_h": [0, 0, 2], "power": 1.5},
        turn(-40),
        [0] * 3,
        [0, 0, 2 * DEG_H * ((radians(40) - UP) / radians(10)) ** 1.5],
    ),
    # 3 deg/h/g² of x times z, both half of the root of two
    (
        "gyro_anisoelasticity",
        {"k_deg_h_g2": [1, 3, 2]},
        rest([sqrt(0.5), 0, sqrt(0.5)]),
        [0] * 3,
        [0, 3 * G**2 / 2 * DEG_H, 0],
    ),
    # the strain of +g less that of −g is twice the offset: at first relaxed, then upright
    (
        "gyro_remanence",
        {"offset_deg_h": [1, 2, 3]},
        rest("-z"),
        [0] * 3,
        [0, 0, -3 * (G - 0.9) / 0.1 * DEG_H],
    ),
    # 100 ppm of the magnitude, forward and backward alike
    (
        "gyro_scale_asymmetry",
        {"asymmetry_ppm": [0, 0, 100]},
        turn(40),
        [0] * 3,
        [0, 0, 100e-6 * Z40],
    ),
    (
        "gyro_scale_asymmetry",
        {"asymmetry_ppm": [0, 0, 100]},
        turn(-40),
        [0] * 3,
        [0, 0, 100e-6 * (radians(40) - UP)],
    ),
    # the scale factor is greater upright and smaller head over heels
    ("gyro_scale_g_dependence", {"k_ppm_g": [0, 0, 50]}, turn(10), [0] * 3, [0, 0, 5e-5 * Z10 * G]),
    (
        "gyro_scale_g_dependence",
        {"k_ppm_g": [0, 0, 50]},
        turn(10, "-z"),
        [0] * 3,
        [0, 0, 5e-5 * Z10 * G],  # about −z: z feels −10 deg/s and −1 g
    ),
    # 10 K above the reference
    ("gyro_scale_temperature", {"k_ppm_k": [0, 0, 5]}, turn(10), [0] * 3, [0, 0, 5e-5 * Z10]),
    (
        "gyro_bias_temperature",
        {"k_deg_h_k": [1, 0, -2]},
        rest(),
        [0] * 3,
        [10 * DEG_H, 0, -20 * DEG_H],
    ),
    (
        "accel_scale_temperature",
        {"k_ppm_k": [0, 0, 5]},
        rest("-z"),
        [0, 0, -5e-5 * GRAVITY],
        [0] * 3,
    ),
    (
        "accel_bias_temperature",
        {"k_micro_g_k": [3, 0, 4]},
        rest(),
        [30 * MICRO_G, 0, 40 * MICRO_G],
        [0] * 3,
    ),
    # north 13 deg/h, up 7.6 deg/h: one within the band, the other not
    ("gyro_dead_band", {"width_deg_h": [10, 10, 10]}, rest(), [0] * 3, [0, 0, -UP]),
    ("gyro_dead_band", {"width_deg_h": [10, 10, 10]}, rest("-z"), [0] * 3, [0, 0, UP]),
    ("gyro_saturation", {"limit_deg_s": [30] * 3}, turn(40), [0] * 3, [0, 0, radians(30) - Z40]),
    ("gyro_saturation", {"limit_deg_s": [30] * 3}, turn(-40), [0] * 3, [0, 0, radians(10) - UP]),
    ("accel_saturation", {"limit_g": [0.5] * 3}, rest(), [0, 0, STANDARD / 2 - GRAVITY], [0] * 3),
    (
        "accel_saturation",
        {"limit_g": [0.5] * 3},
        rest("-z"),
        [0, 0, GRAVITY - STANDARD / 2],
        [0] * 3,
    ),
    # odd, even, and products that only a slanting case has
    (
        "accel_cubic",
        {"k3_micro_g_g3": [0, 0, 50]},
        rest("-z"),
        [0, 0, -50 * MICRO_G * G**3],
        [0] * 3,
    ),
    (
        "accel_scale_asymmetry",
        {"asymmetry_micro_g_g": [0, 0, 50]},
        rest("-z"),
        [0, 0, 50 * MICRO_G * G],
        [0] * 3,
    ),
    (
        "accel_cross_products",
        {"matrix_micro_g_g2": [[40, 1, 2], [3, 4, 5], [60, 7, 8]]},
        rest(),
        [0] * 3,
        [0] * 3,
    ),
    (
        "accel_cross_products",
        {"matrix_micro_g_g2": [[40, 1, 2], [30, 4, 5], [60, 7, 8]]},
        rest([0, 1, 1]),
        [20 * MICRO_G * G**2, 15 * MICRO_G * G**2, 30 * MICRO_G * G**2],  # f_y f_z = g²/2
        [0] * 3,
    ),
    # the gyros' x axis has moved 2 mrad from z: it feels so much less of the turn about z
    (
        "gyro_accel_misalignment",
        {"rotation_mrad": [0, 2, 0]},
        turn(40),
        [0] * 3,
        [-sin(2e-3) * Z40, 0, (cos(2e-3) - 1) * Z40],
    ),
]


@pytest.mark.parametrize(("name", "parameters", "move", "force", "rate"), BY_HAND)
def test_the_reading_is_off_by_what_is_reckoned_by_hand(
    performed: Performed,
    name: str,
    parameters: Document,
    move: Document,
    force: list[float],
    rate: list[float],
) -> None:
    """To 0.01 % of the rate of a turn, for the earth's level rate goes round with the case."""
    accelerometer, gyro = added(performed, name, parameters, move)
    assert accelerometer == pytest.approx(force, abs=1e-11)
    assert gyro == pytest.approx(rate, rel=1e-4, abs=2e-8 if move["do"] == "turn" else 1e-13)


def deviation(recording: Recording, log: str, sensor: str) -> Any:
    """Reading less truth, sample by sample, (n − 1, 3), m/s² or rad/s."""
    truth = recording.truth[log]
    true = {"gyro": truth.rate, "accelerometer": truth.force}[sensor]
    return np.diff(getattr(truth.noisy, sensor), axis=0) / 0.01 - true[1:]


@pytest.mark.parametrize(
    ("name", "parameters", "sensor", "course"),
    [
        (
            "gyro_warm_up",
            {"start_deg_h": [0, 0, 5], "time_constant_s": 30},
            "gyro",
            lambda t: 5 * DEG_H * np.exp(-t / 30),
        ),
        (
            "accel_warm_up",
            {"start_micro_g": [0, 0, 100], "time_constant_s": 30},
            "accelerometer",
            lambda t: 100 * MICRO_G * np.exp(-t / 30),
        ),
        (
            "gyro_bias_jump",
            {"size_deg_h": [0, 0, 10], "at_s": 81.005},
            "gyro",
            lambda t: 10 * DEG_H * np.clip((t - 81.0) / 0.01, 0, 1),
        ),
        (
            "accel_bias_jump",
            {"size_micro_g": [0, 0, 10], "at_s": 81.005},
            "accelerometer",
            lambda t: 10 * MICRO_G * np.clip((t - 81.0) / 0.01, 0, 1),
        ),
        (
            "gyro_cubic_drift",
            {"k_deg_h_h3": [0, 0, 1000]},
            "gyro",
            lambda t: 1000 * DEG_H * (t / 3600) ** 3,
        ),
        (
            "gyro_late_drift",
            {"ramp_deg_h_h": [0, 0, 360], "from_s": 90},
            "gyro",
            lambda t: 0.1 * DEG_H * np.maximum(t - 90, 0),
        ),
        (
            "gyro_disturbance",
            {"size_deg_h": [0, 0, 3], "from_s": 10, "to_s": 90},
            "gyro",
            lambda t: 3 * DEG_H * ((t > 10) & (t < 90)),
        ),
        (
            "cyclic_drift",
            {"accelerometer_micro_g": [0, 0, 7], "period_s": 40, "phase_deg": 90},
            "accelerometer",
            lambda t: 7 * MICRO_G * np.cos(2 * np.pi * t / 40),
        ),
    ],
)
def test_biases_go_on_through_the_pause(
    performed: Performed, name: str, parameters: Document, sensor: str, course: Any
) -> None:
    """Two rests of 20 s, a minute apart, and the means of samples that hold a jump exactly."""
    plan = [rest(name=name, seconds=20) for name in ("one", "two")]
    recording = performed(*plan, effects={name: parameters})
    for log in ("one", "two"):
        middle = recording.truth[log].time[1:] - 0.005
        off = deviation(recording, log, sensor)
        assert off[:, 2] == pytest.approx(course(middle), rel=1e-6, abs=1e-11)
        assert np.abs(off[:, :2]).max() < 1e-11


def test_an_imu_that_has_turned_in_its_fixture_senses_along_other_axes(
    performed: Performed,
) -> None:
    """By 10° about y between two rests with z up: then x points down by 10°, z is off upright."""
    plan = [rest(name=name, seconds=20) for name in ("one", "two")]
    shift = {"rotation_arcsec": [0, 36000, 0], "at_s": 50}
    recording = performed(*plan, effects={"mounting_shift": shift})
    assert np.abs(deviation(recording, "one", "accelerometer")).max() < 1e-9
    off = deviation(recording, "two", "accelerometer").mean(axis=0)
    ten = radians(10)
    assert off == pytest.approx([-GRAVITY * sin(ten), 0, GRAVITY * (cos(ten) - 1)], abs=1e-9)
    off = deviation(recording, "two", "gyro").mean(axis=0)  # x to the north: what it loses
    felt = [NORTH * (cos(ten) - 1) - UP * sin(ten), 0, UP * (cos(ten) - 1) + NORTH * sin(ten)]
    assert off == pytest.approx(felt, abs=1e-12)


def test_a_bias_follows_the_rate_of_the_temperature(performed: Performed) -> None:
    """2 °/h per K/min at 36 K/h, 0.6 K/min."""
    also = {"temperature": {"start_deg_c": 20, "slope_k_h": 36}}
    effects = {"gyro_temperature_rate": {"k_deg_h_k_min": [0, 0, 2]}}
    off = deviation(performed(rest(), effects=effects, also=also), "still", "gyro")
    assert off[:, 2] == pytest.approx(1.2 * DEG_H, rel=1e-6)


def test_a_scale_factor_drifts_with_time(performed: Performed) -> None:
    """3600 ppm/h are 1 ppm/s: at 100 s 100 ppm of what the earth turns."""
    plan = [rest(name=name, seconds=20) for name in ("one", "two")]
    drift = {"k_ppm_h": [0, 0, 3600]}
    recording = performed(*plan, effects={"gyro_scale_ramp": drift, "accel_scale_ramp": drift})
    middle = recording.truth["two"].time[1:] - 0.005
    off = deviation(recording, "two", "gyro")[:, 2]
    assert off == pytest.approx(1e-6 * middle * UP, rel=1e-5)
    off = deviation(recording, "two", "accelerometer")[:, 2]
    assert off == pytest.approx(1e-6 * middle * GRAVITY, rel=1e-5)


def test_a_temperature_coefficient_drifts_with_time(performed: Performed) -> None:
    """2 °/h per K and hour, 10 K above the reference: at 18 s 0.1 °/h."""
    effects = {"gyro_coefficient_drift": {"k_deg_h_k_h": [0, 0, 2]}}
    recording = performed(rest(), effects=effects, also=WARM)
    middle = recording.truth["still"].time[1:] - 0.005
    off = deviation(recording, "still", "gyro")[:, 2]
    assert off == pytest.approx(20 * DEG_H * middle / 3600, rel=1e-5)


def test_a_stray_field_goes_with_the_angle_of_a_turn(performed: Performed) -> None:
    """At 40 °/s and 2.5 periods per revolution the period is 3.6 s; it ends with the turn."""
    move = turn(40) | {"rate_deg_s": 40, "degrees": 720, "log": "turn", "id": "turn"}
    del move["seconds"]
    told = {"size_deg_h": [5, 0, 0], "order": 2.5, "phase_deg": 0}
    recording = performed(move, rest(), effects={"gyro_stray_field": told})
    off = deviation(recording, "turn", "gyro")[:, 0]
    steady = off[1400:1760]
    assert np.abs(steady).max() == pytest.approx(5 * DEG_H, rel=1e-3)
    assert steady == pytest.approx(-off[1580:1940], abs=1e-3 * DEG_H)  # half a period later
    assert deviation(recording, "still", "gyro") == pytest.approx(0, abs=1e-12)


def test_a_temperature_warms_up_drifts_and_jumps(performed: Performed) -> None:
    also = {
        "temperature": {
            "start_deg_c": 20,
            "slope_k_h": 36,
            "warm_up": {"rise_k": 10, "time_constant_s": 25},
            "step": {"size_k": -2, "at_s": 90},
        }
    }
    plan = [rest(name=name, seconds=20) for name in ("one", "two")]
    effects = {"accel_bias_temperature": {"k_micro_g_k": [0, 0, 1000]}}
    recording = performed(*plan, effects=effects, also=also)
    truth = recording.truth["two"]
    at = {round(t, 6): k for t, k in zip(truth.time, truth.temperature - 273.15, strict=True)}
    assert at[85.0] == pytest.approx(20 + 0.85 + 10 * (1 - exp(-85 / 25)), abs=1e-9)
    assert at[95.0] == pytest.approx(18 + 0.95 + 10 * (1 - exp(-95 / 25)), abs=1e-9)
    off = deviation(recording, "two", "accelerometer")[:, 2]
    between = (truth.temperature[1:] + truth.temperature[:-1]) / 2 - 293.15
    calm = np.abs(np.diff(truth.temperature)) < 1  # not the sample of the jump
    assert off[calm] == pytest.approx(1000 * MICRO_G * between[calm], rel=1e-5)


def test_hysteresis_keeps_the_side_that_was_last_up(performed: Performed) -> None:
    """z lies level after it was up, and after it was down; at first it has been neither.

    Where it is up or down the loop is closed, to what gravity is short of 9.80665 m/s²: s of it.
    Contacts that give way at r have p = G − r up, and level again the smaller of r and G − r, of
    which the means are G − 1/2 and 1/4 − s/2.
    """
    s = 1 - G
    ups = ["+x", "+z", "+x", "-z", "+x"]
    plan = [rest(up, f"{k}") for k, up in enumerate(ups)]
    effects = {"accel_hysteresis": {"offset_micro_g": [0, 0, 20]}}
    recording = performed(*plan, effects=effects)
    for k, share in enumerate([0, -2 * s, 1 - 2 * s, 2 * s, 2 * s - 1]):
        off = deviation(recording, f"{k}", "accelerometer")
        assert off[:, 2] == pytest.approx(share * 20 * MICRO_G, abs=1e-11)


def test_hysteresis_after_a_small_force_is_small(performed: Performed) -> None:
    """Rayleigh's loop of half its reach has a quarter of its width; 30° is g/2, of ten contacts."""
    oblique = [float(np.sqrt(0.75)), 0, 0.5]
    plan = [rest(up, f"{k}") for k, up in enumerate(["+x", oblique, "+x"])]
    recording = performed(*plan, effects={"accel_hysteresis": {"offset_micro_g": [0, 0, 20]}})
    off = deviation(recording, "2", "accelerometer")
    assert off[:, 2] == pytest.approx(20 * MICRO_G / 4, rel=0.05)


def test_gyros_keep_the_way_of_their_last_turn(performed: Performed) -> None:
    """Each spring slips at 5 °/s at the most, so that 40 °/s and back load all of them wholly.

    The earth's 15 °/h stretch them by a thousandth.
    """
    plan = [rest(name="first"), turn(40) | {"rate_deg_s": 40, "log": "turn"}, rest(name="last")]
    del plan[1]["seconds"]
    plan[1]["id"] = "turn"
    effects = {"gyro_hysteresis": {"offset_deg_h": [1, 1, 2]}}
    for way in (1, -1):
        plan[1]["degrees"] = way * 360
        recording = performed(*plan, effects=effects)
        assert deviation(recording, "first", "gyro") == pytest.approx(0, abs=2e-3 * DEG_H)
        expected = np.broadcast_to([0, 0, way * 2 * DEG_H], (399, 3))
        assert deviation(recording, "last", "gyro") == pytest.approx(expected, abs=4e-3 * DEG_H)
        steady = deviation(recording, "turn", "gyro")[1300:1699]
        assert steady == pytest.approx(-expected, abs=4e-3 * DEG_H)


def test_a_slow_turn_loads_the_springs_in_part(performed: Performed) -> None:
    """3 °/s stretch three of four springs and let them go; that of 2 °/s slips by 1 °/s.

    Back at rest it is pushed by that, half of its largest force, and of all four an eighth.
    """
    slow = turn(3) | {"rate_deg_s": 3, "log": "turn", "id": "turn", "degrees": 12}
    del slow["seconds"]
    plan = [rest(name="first"), slow, rest(name="last")]
    recording = performed(*plan, effects={"gyro_hysteresis": {"offset_deg_h": [0, 0, 2]}})
    last = deviation(recording, "last", "gyro")
    assert last[:, 2] == pytest.approx(2 * DEG_H * 0.5 / 4, rel=0.01)


def test_gyros_stay_magnetised_by_the_last_turn(performed: Performed) -> None:
    """40 °/s turn all the domains over; 3.5 °/s back two of four, and the others keep the sense."""
    plan = [turn(40) | {"rate_deg_s": 40, "log": "turn"}, rest(name="last")]
    back = turn(3.5) | {"rate_deg_s": 3.5, "log": "back", "id": "back", "degrees": -21}
    for one in (plan[0], back):
        del one["seconds"]
    plan[0]["id"] = "turn"
    plan += [back, rest(name="then")]
    effects = {"gyro_bias_sense": {"offset_deg_h": [1, 1, 2]}}
    for way in (1, -1):
        plan[0]["degrees"], back["degrees"] = way * 360, -way * 21
        recording = performed(*plan, effects=effects)
        expected = np.broadcast_to([0, 0, way * 2 * DEG_H], (399, 3))
        assert deviation(recording, "last", "gyro") == pytest.approx(expected, abs=4e-3 * DEG_H)
        assert deviation(recording, "then", "gyro") == pytest.approx(0, abs=4e-3 * DEG_H)
        steady = deviation(recording, "turn", "gyro")[1300:1699]
        assert steady == pytest.approx(expected, abs=4e-3 * DEG_H)


def test_a_vibration_scatters_and_shifts_while_it_lasts(performed: Performed) -> None:
    """0.1 g for 20 s: 0.5 g/g² × 0.01 g² = 5 mg under a scatter of 0.1 g, 5 sigma of 2000."""
    shake = {"vibration_g": 0.1, "from_s": 9.99, "to_s": 29.99}
    effects = {"accel_vibration_rectification": {"k_micro_g_g2": [0, 0, 5e5]} | shake}
    recording = performed(rest(seconds=40), effects=effects)
    off = deviation(recording, "still", "accelerometer") / STANDARD
    calm = np.r_[0:999, 3000:3999]
    assert np.abs(off[calm]).max() < 1e-12
    shaken = off[1000:2999]
    assert np.std(shaken, axis=0) == pytest.approx(0.1, rel=5 / sqrt(2 * 2000))
    assert shaken.mean(axis=0) == pytest.approx([0, 0, 5e-3], abs=5 * 0.1 / sqrt(2000))
    truth = recording.truth["still"]  # the shift alone, without the scatter
    shift = np.diff(truth.noiseless.accelerometer, axis=0) / 0.01 - truth.force[1:]
    assert shift[1000:2999, 2] / STANDARD == pytest.approx(5e-3, abs=1e-9)


def slow(ideal: Callable[..., Document], seconds: float, effects: Document) -> Any:
    """Ten samples a second of a long rest: what the gyros read beside the truth, (n, 3), rad/s."""
    document = ideal(rest(seconds=seconds), effects=effects)
    document["receiver"]["rate_hz"] = 10
    truth = perform(specify(document)).truth["still"]
    return np.diff(truth.noisy.gyro - truth.noiseless.gyro, axis=0) / 0.1


def test_flicker_has_a_level_allan_deviation(ideal: Callable[..., Document]) -> None:
    """0.664 B from 5 s to 100 s; of the 3 × 120 means of 100 s it is good to 4 %: bar 15 %."""
    noise = slow(ideal, 12_000, {"gyro_flicker": {"instability_deg_h": 2}}) / DEG_H
    for samples in (50, 200, 1000):
        means = noise[: len(noise) // samples * samples].reshape(-1, samples, 3).mean(axis=1)
        allan = sqrt(np.mean(np.diff(means, axis=0) ** 2) / 2)
        assert allan == pytest.approx(0.664 * 2, rel=0.15), samples


def test_noise_of_the_angle_does_not_add_up(performed: Performed) -> None:
    """The angle from any sample to any later one is off by √2 Q, over one sample or over many."""
    move = rest(seconds=100)
    noisy, ideal = (
        performed(move, effects=each).truth["still"].noisy.gyro
        for each in ({"gyro_angle_noise": {"q_arcsec": 2}}, {})
    )
    off = np.degrees(noisy - ideal) * 3600
    for samples in (1, 10, 1000):
        change = off[samples:] - off[:-samples]
        assert change.std() == pytest.approx(2 * sqrt(2), rel=0.04), samples


def test_the_noise_of_a_scale_factor_goes_with_the_rate(performed: Performed) -> None:
    """200 ppm√s of 40 °/s in samples of 10 ms: 0.08 °/s; of half the rate half as much."""
    effects = {"gyro_rate_noise": {"relative_ppm_sqrt_s": [0, 0, 200]}}
    for rate, expected in ((40, 0.08), (-20, 0.04)):
        move = turn(rate) | {"rate_deg_s": abs(rate)}
        del move["seconds"]
        noisy, ideal = (
            performed(move, effects=each).truth["still"].noisy.gyro for each in (effects, {})
        )
        noise, truth = (np.degrees(np.diff(each, axis=0)) / 0.01 for each in (noisy - ideal, ideal))
        steady = noise[np.abs(truth[:, 2] - rate) < 0.01]
        close = 5 / sqrt(2 * len(steady))
        assert steady[:, 2].std() == pytest.approx(expected, rel=close)
        assert np.abs(noise[:, :2]).max() < 1e-9


def test_a_telegraph_has_two_levels_and_the_dwell_that_is_asked_for(
    ideal: Callable[..., Document],
) -> None:
    """20 s between two jumps, 12 000 s: 600 jumps, 5 sigma of √600."""
    effects = {"gyro_telegraph": {"height_deg_h": [3, 0, -1], "dwell_s": 20}}
    noise = slow(ideal, 12_000, effects) / DEG_H
    up, down = np.isclose(noise[:, 0], 3), np.isclose(noise[:, 0], -3)
    assert np.mean(up | down) > 0.99  # the others hold a jump
    jumps = np.abs(np.diff(np.sign(noise[:, 0]))).sum() / 2
    assert jumps == pytest.approx(600, abs=5 * sqrt(600))
    assert np.abs(noise[:, 1]).max() < 1e-9
    assert noise[:, 2] == pytest.approx(-noise[:, 0] / 3, abs=1e-9)


def test_gyros_that_lag_by_two_samples_tell_what_was_two_samples_ago(performed: Performed) -> None:
    """Through turns and steps; the accelerometers are on time."""
    plan = [
        {"id": "turn", "do": "turn", "up": "+z", "degrees": 90, "rate_deg_s": 30, "log": "turn"}
        | {"accel_deg_s2": 60},
        {"id": "tumble", "do": "tumble", "up": "+z", "about": "+x", "step_degrees": 90, "steps": 3}
        | {"seconds": 1, "log": "tumble"},
    ]
    also = {"handling": {"still_s": 0.1, "step": {"rate_deg_s": 90, "accel_deg_s2": 180}}}
    arm = {"lever_arm": {"arm_m": [0.1, 0, 0]}}
    lagging = performed(*plan, effects=arm | {"gyro_latency": {"lag_ms": 20}}, also=also).truth
    on_time = performed(*plan, effects=arm, also=also).truth
    for log in ("turn", "tumble"):
        late, prompt = (np.diff(truth[log].noisy.gyro, axis=0) for truth in (lagging, on_time))
        assert late[2:] == pytest.approx(prompt[:-2], abs=1e-12)
        assert np.abs(late - prompt).max() > 1e-4
        assert np.array_equal(lagging[log].accelerometer, on_time[log].accelerometer)


def test_a_lag_of_half_a_sample_is_seen_on_the_ramps_alone(performed: Performed) -> None:
    """At 40 deg/s² a lag of 5 ms reads 0.2 deg/s too little; 0.2 deg/s² of a turn is no angle."""
    move = turn(40) | {"rate_deg_s": 40}
    del move["seconds"]
    also = {"handling": {"still_s": 1}}
    late, prompt = (
        np.diff(performed(move, effects=effects, also=also).truth["still"].noisy.gyro[:, 2])
        for effects in ({"gyro_latency": {"lag_ms": 5}}, {})
    )
    less = (prompt - late) / 0.01
    assert less[105:195] == pytest.approx(radians(0.2), rel=1e-6)
    assert less[210:290] == pytest.approx(0, abs=1e-12)
    assert late.sum() == pytest.approx(prompt.sum(), abs=1e-10)


def test_accelerometers_at_places_of_their_own_feel_forces_of_their_own(
    ideal: Callable[..., Document],
) -> None:
    """ω² r of each; in one point they are a lever arm, to the last digit and askew as well."""
    move = turn(40) | {"rate_deg_s": 40}
    del move["seconds"]
    document = ideal(move, also={"handling": {"still_s": 1}})
    arms = [[30, 0, 0], [0, -20, 0], [0, 0, 10]]
    truth = perform(specify(document | {"effects": {"size_effect": {"arms_mm": arms}}})).truth
    steady = truth["still"].force[220:280]
    expected = [-0.030 * radians(40) ** 2, 0.020 * radians(40) ** 2, GRAVITY]
    assert steady == pytest.approx(np.broadcast_to(expected, steady.shape), abs=1e-9)
    document["truth"]["accelerometer"]["matrix"] = [[1, 0.02, 0.01], [0, 1.01, 0], [-0.03, 0, 1]]
    for name, parameters in (
        ("size_effect", {"arms_mm": [[30, 10, 5]] * 3}),
        ("lever_arm", {"arm_m": [0.030, 0.010, 0.005]}),
    ):
        document["effects"] = {name: parameters}
        truth = perform(specify(document)).truth
        if name == "size_effect":
            sized = truth["still"].noisy.accelerometer
    assert truth["still"].noisy.accelerometer == pytest.approx(sized, abs=1e-12)


def test_an_oscillation_bound_to_the_table_follows_its_rate(performed: Performed) -> None:
    """180 times per revolution: 20 Hz at 40 deg/s and 10 Hz at 20 deg/s, both of 0.01 rad/s."""
    effects = {"oscillation": {"order": 180, "amplitude_rad_s": 0.01, "axis": "+x"}}
    for rate, frequency in ((40, 20), (20, 10)):
        move = {"id": "turn", "do": "turn", "up": "+z", "mark": "+x", "degrees": 16 * rate}
        move |= {"rate_deg_s": rate, "accel_deg_s2": 2 * rate}
        also = {"handling": {"still_s": 1}}
        with_it, without = (
            performed(move, effects=one, also=also).truth["all.asc"].rate for one in (effects, {})
        )
        rung = (with_it - without)[200:1200, 0]  # 10 s
        spectrum = np.abs(np.fft.rfft(rung)) * 2 / len(rung)
        assert int(np.argmax(spectrum)) == 10 * frequency
        assert spectrum.max() == pytest.approx(0.01 * np.sinc(frequency * 0.01), rel=1e-4)
        assert (with_it - without)[:, 0].sum() * 0.01 == pytest.approx(0, abs=1e-9)


def test_biases_are_others_after_each_switch_on(performed: Performed) -> None:
    """40 logs: 120 biases of each sensor, whose scatter is known to 6.5 %; constant in a log."""
    plan = [rest(name=f"still-{number}", seconds=1) for number in range(40)]
    parameters = {"gyro_deg_h": 3, "accelerometer_micro_g": 50}
    found = []
    for effects in ({"turn_on_bias": parameters}, {}):
        truth = performed(*plan, effects=effects).truth
        readings = [np.hstack([o.noisy.accelerometer, o.noisy.gyro]) for o in truth.values()]
        found.append(np.array([np.diff(sums, axis=0) / 0.01 for sums in readings]))
    biases = found[0] - found[1]
    assert np.abs(np.ptp(biases, axis=1)).max() < 1e-9
    forces, rates = biases.mean(axis=1)[:, :3], biases.mean(axis=1)[:, 3:]
    assert forces.std() == pytest.approx(50 * MICRO_G, rel=0.25)
    assert rates.std() == pytest.approx(3 * DEG_H, rel=0.25)
    assert abs(np.corrcoef(rates[:-1].ravel(), rates[1:].ravel())[0, 1]) < 0.4


def test_a_low_pass_delays_a_ramp_by_its_time_constant_and_loses_no_angle(
    performed: Performed,
) -> None:
    """At 40 deg/s² by τ = 20 ms: 0.8 deg/s too little, after e⁻¹ of that at τ into the ramp."""
    move = turn(40) | {"rate_deg_s": 40}
    del move["seconds"]
    also = {"handling": {"still_s": 1}}
    low = {"gyro_low_pass": {"time_constant_ms": [0, 0, 20]}}
    late, prompt = (
        np.diff(performed(move, effects=effects, also=also).truth["still"].noisy.gyro[:, 2])
        for effects in (low, {})
    )
    less = (prompt - late) / 0.01
    assert less[120:198] == pytest.approx(radians(0.8), rel=0.01)
    # The mean of 1 − e^(−t/τ) over the sample from τ/2 to τ after the ramp has begun.
    begun = int(np.argmax(np.abs(prompt - prompt[0]) > 1e-9))
    mean = 1 - 2 * (np.exp(-0.5) - np.exp(-1))
    assert less[begun + 1] == pytest.approx(radians(0.8) * mean, rel=0.02)
    assert late.sum() == pytest.approx(prompt.sum(), abs=1e-10)


def test_a_low_pass_lessens_white_noise_by_its_bandwidth(performed: Performed) -> None:
    """White noise sampled at T through τ = 10 T: its variance is about T/(2τ) of what it was."""
    still = rest("+z") | {"seconds": 1200}
    noise = {"angle_random_walk_deg_sqrt_h": 0.1}
    low = {"gyro_low_pass": {"time_constant_ms": [100, 0, 0]}}
    slow, plain = (
        np.diff(performed(still, effects=one, **noise).truth["still"].noisy.gyro, axis=0)
        for one in (low, {})
    )
    ratio = slow.var(axis=0) / plain.var(axis=0)
    assert ratio[0] == pytest.approx(0.05, rel=0.1)
    assert ratio[1:] == pytest.approx(1)


def test_gyros_recover_after_a_turn_about_any_axis(performed: Performed) -> None:
    """About z: x and y too have it; with the sense of the turn only z has, and as it was in it."""
    plan = [turn(40) | {"rate_deg_s": 40, "log": "turn", "id": "turn", "degrees": -360}]
    del plan[0]["seconds"]
    both = {"in_turn_deg_h": [9, 0, 0], "after_deg_h": [0, 4, 8], "time_constant_s": 5}
    own = {"offset_deg_h": [1, 1, 8], "time_constant_s": 5}
    for name, hidden, expected, in_turn in (
        ("gyro_relaxation", both, [0, 4, 8], [9, 0, 0]),
        ("gyro_relaxation_sense", own, [0, 0, -8], [0, 0, -8]),
        ("gyro_relaxation_braking", own, [0, 0, -8], [0, 0, 0]),
    ):
        recording = performed(*plan, effects={name: hidden})
        steady = deviation(recording, "turn", "gyro")[1300:1699]
        assert steady == pytest.approx(np.tile(in_turn, (399, 1)) * DEG_H, abs=4e-3 * DEG_H)
        first, later = deviation(recording, "turn", "gyro")[[-301, -101]] / DEG_H
        assert later == pytest.approx(np.exp(-0.4) * first, abs=0.02)  # 2 s, 100 Hz
        shares = first[np.nonzero(expected)] / np.array(expected)[np.nonzero(expected)]
        assert shares == pytest.approx(shares[0], abs=0.01) and 0.1 < shares[0] < 1
        assert first[np.equal(expected, 0)] == pytest.approx(0, abs=0.01)
