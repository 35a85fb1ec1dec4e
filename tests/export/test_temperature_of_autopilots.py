"""TC_* and INS_TCAL1_*: applied as the firmware does it, they reproduce the curve of the bias."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from inertial.campaign.measurement import EffectOfResult
from inertial.effects import KNOWN
from stages.export.autopilots import ARDUPILOT, PX4, parameter_file
from stages.export.calibration import Calibration
from stages.export.document import document
from tests.export.made_up import calibration, mount
from tests.export.readers import Array, mavproxy, qgroundcontrol
from tests.expressions import value_of

ICE = 273.15
T0, LOWEST, HIGHEST = 22.0, -15.0, 65.0  # °C
AT = np.linspace(LOWEST, HIGHEST, 33)
Functions = Mapping[str, float]


def effect(name: str, numbers: Functions, knots: Functions | None = None) -> EffectOfResult:
    """An effect of a result with its numbers; knots in °C."""
    kelvin = {"T0": T0, "T_min": LOWEST, "T_max": HIGHEST, **(knots or {})}
    constants = {key: value + ICE for key, value in kelvin.items()}

    def rows(values: Functions) -> dict[str, dict[str, Any]]:
        return {
            key: {"parameter": f"{name}.{key}", "value": value, "sigma": 1e-9, "unit": "1"}
            | {"meaning": ""}
            for key, value in values.items()
        }

    return EffectOfResult(KNOWN[name].with_constants(constants), rows(numbers), rows(constants))


def warm(accel: EffectOfResult | None, gyro: EffectOfResult | None) -> Calibration:
    one = mount()
    one = replace(
        one,
        accelerometer=replace(one.accelerometer, effects=[accel] if accel else []),
        gyroscope=replace(one.gyroscope, effects=[gyro] if gyro else []),
    )
    recorded = {"mean": T0 + ICE, "lowest": LOWEST + ICE, "highest": HIGHEST + ICE}
    return replace(calibration(one), temperature=recorded)


def px4_offset(values: Mapping[str, Any], sensor: str, at: Array) -> Array:
    """calc_thermal_offsets_3D of PX4 with the constant offset, (k, 3), at °C."""
    letter, short = {"accelerometer": ("A", "ACC"), "gyroscope": ("G", "GYRO")}[sensor]
    p = {key.removeprefix(f"TC_{letter}0_"): float(value) for key, value in values.items()}
    d = (np.clip(at, p["TMIN"], p["TMAX"]) - p["TREF"])[:, None]
    x = [np.array([p[f"X{n}_{i}"] for i in range(3)]) for n in range(4)]
    off = np.array([float(values[f"CAL_{short}0_{axis}OFF"]) for axis in "XYZ"])
    return off + x[0] + x[1] * d + x[2] * d**2 + x[3] * d**3


def ardupilot_offset(values: Mapping[str, Any], sensor: str, at: Array) -> Array:
    """TCal::correct_sensor of ArduPilot with the constant offset, (k, 3), at °C."""
    short, off = {"accelerometer": ("ACC", "ACCOFFS"), "gyroscope": ("GYR", "GYROFFS")}[sensor]
    c = np.array(
        [[float(values[f"INS_TCAL1_{short}{n}_{axis}"]) for axis in "XYZ"] for n in (1, 2, 3)]
    )
    low, high = float(values["INS_TCAL1_TMIN"]), float(values["INS_TCAL1_TMAX"])

    def polynomial(temperature: Array) -> Array:
        d = (np.clip(temperature, low, high) - 35.0)[:, None]
        return (c[0] + (c[1] + c[2] * d) * d) * d * 1e-6

    at_calibration = np.array([float(values[f"INS_{short}1_CALTEMP"])])
    constant = np.array([float(values[f"INS_{off}_{axis}"]) for axis in "XYZ"])
    return constant + polynomial(at) - polynomial(at_calibration)


def offsets(calibration: Calibration, sensor: str, at: Array) -> list[Array]:
    """By PX4 and by ArduPilot."""
    return [
        px4_offset(qgroundcontrol(parameter_file(calibration, PX4)), sensor, at),
        ardupilot_offset(mavproxy(parameter_file(calibration, ARDUPILOT)), sensor, at),
    ]


def head(calibration: Calibration) -> str:
    text = parameter_file(calibration, PX4)
    return " ".join(text.replace("\n#", "").split())


def test_a_cubic_is_reproduced_to_single_precision() -> None:
    """x cubic, y straight, z constant; beyond the range it stays as it is at its end."""
    made = warm(
        effect("accel_temperature", {"bias_x_1": 2e-3, "bias_x_2": -4e-5, "bias_x_3": 5e-7}),
        effect("gyro_bias_temperature", {"k_x": 0.0, "k_y": -3e-6, "k_z": 0.0}),
    )
    d = AT - T0
    bias = mount().accelerometer.bias
    expected = np.column_stack([2e-3 * d - 4e-5 * d**2 + 5e-7 * d**3, 0 * d, 0 * d]) + bias
    for given in offsets(made, "accelerometer", AT):
        assert given == pytest.approx(expected, abs=3e-7)
    for given in offsets(made, "gyroscope", AT):
        assert given - mount().gyroscope.bias == pytest.approx(
            np.column_stack([0 * d, -3e-6 * d, 0 * d]), abs=1e-10
        )
    for end, beyond in ((0, LOWEST - 30), (-1, HIGHEST + 30)):
        for given in offsets(made, "accelerometer", np.array([beyond])):
            assert given[0] == pytest.approx(expected[end], abs=3e-7)
    assert "knee" not in head(made) and "valid from -15.0 to 65.0 degC" in head(made)


def test_a_knee_becomes_the_best_cubic_and_its_error_is_stated() -> None:
    """The bend at 15 °C is below T0, so the offset at T0 holds its part of the change, 7 K."""
    slopes = {"bias_z_1": 1e-3, "bias_z_bend": -3e-3}
    made = warm(effect("accel_temperature", slopes, {"knot_bias_z": 15.0}), None)
    bias = mount().accelerometer.bias[2]
    knee = bias + 1e-3 * (AT - T0) - 3e-3 * np.maximum(AT - 15, 0)
    at_t0 = bias - 3e-3 * 7
    fine = np.linspace(LOWEST, HIGHEST, 2001)
    d, curve = fine - T0, 1e-3 * (fine - T0) - 3e-3 * (np.maximum(fine - 15, 0) - 7)
    best = np.linalg.lstsq(np.vander(d, 4)[:, :3], curve, rcond=None)[0]
    error = np.abs(np.vander(d, 4)[:, :3] @ best - curve).max()
    for given in offsets(made, "accelerometer", AT):
        assert np.abs(given[:, 2] - knee).max() <= 1.01 * error
        at_reference = offsets(made, "accelerometer", np.array([T0]))
        assert [one[0, 2] for one in at_reference] == pytest.approx([at_t0] * 2, abs=1e-8)
    assert f"off by up to 0, 0, {error:.2g} m/s^2" in head(made)


def test_the_equation_of_the_json_is_the_mean_over_three_knots_and_says_its_range() -> None:
    """Below all knots only the powers count, above them each bend by its way beyond its knot."""
    numbers = {"bias_z_1": 2e-4, "bias_z_2": 1e-6} | {
        f"bias_z_bend{side}": size
        for side, size in (("_below", 1e-4), ("", 4e-4), ("_above", 1e-4))
    }
    knots = {"knot_bias_z_below": 20.0, "knot_bias_z": 25.0, "knot_bias_z_above": 30.0}
    own = warm(effect("accel_temperature", numbers, knots), None)
    triad = document(own)["mounts"][0]["accelerometer"]
    (stated,) = triad["effects"]
    names = {row["name"]: row["value"] for row in (*stated["parameters"], *stated["constants"])}
    limits = [names[f"accel_temperature.{key}"] - ICE for key in ("T_min", "T_max")]
    assert limits == pytest.approx([LOWEST, HIGHEST])
    names |= {
        "f_x": 0.0,
        "f_y": 0.0,
        "f_z": 0.0,
        "M_zx": 0.0,
        "M_zy": 0.0,
        "M_zz": 1.0,
        "bias_z": 0.0,
    }
    for celsius, bends in ((0.0, 0.0), (22.0, 1e-4 * 2), (60.0, 1e-4 * 40 + 4e-4 * 35 + 1e-4 * 30)):
        d = celsius - T0
        read = value_of(triad["equation"]["z"], names | {"T": celsius + ICE})
        assert read == pytest.approx(2e-4 * d + 1e-6 * d**2 + bends, rel=1e-9)


def test_scale_factors_along_the_temperature_are_named_as_left_out() -> None:
    made = warm(None, effect("gyro_temperature", {"bias_x_1": 1e-6, "scale_y_1": 5e-5}))
    text = head(made)
    assert "TC_G_ENABLE" in text and "TC_A_ENABLE\t1" not in parameter_file(made, PX4)
    assert "gyro_temperature.scale_y_1 * (T - gyro_temperature.T0) * w_y" in text
    whole = warm(None, effect("gyro_temperature", {"bias_x_1": 1e-6}))
    assert "gyro_temperature" not in head(whole)


def test_without_a_dependence_nothing_is_set_and_a_double_correction_is_warned_of() -> None:
    made = warm(None, None)
    for pilot, word in ((PX4, "taken off twice"), (ARDUPILOT, "belongs to other offsets")):
        text = parameter_file(made, pilot)
        assert "\tTC_" not in text and "\nINS_TCAL" not in text
        assert word in " ".join(text.replace("\n#", "").split())
