"""PX4, ArduPilot, Kalibr: the contents are right, and what a file cannot contain is stated."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
import yaml

from stages.export.autopilots import ARDUPILOT, PX4, parameter_file
from stages.export.calibration import Calibration, Triad
from stages.export.noise_yaml import imu_yaml
from tests.export.made_up import EVIL, REASON, USE, calibration, mount, named
from tests.export.readers import Array, corrected, mavproxy, probes, qgroundcontrol, remaining

Writer = Callable[[Calibration], str]
Reader = Callable[[str], dict[str, np.float32]]
PX4_NAMES = ("CAL_ACC0_{}OFF", "CAL_ACC0_{}SCALE", "CAL_GYRO0_{}OFF")
ARDUPILOT_NAMES = ("INS_ACCOFFS_{}", "INS_ACCSCAL_{}", "INS_GYROFFS_{}")


def px4(calibration: Calibration) -> str:
    return parameter_file(calibration, PX4)


def ardupilot(calibration: Calibration) -> str:
    return parameter_file(calibration, ARDUPILOT)


AUTOPILOTS = pytest.mark.parametrize(
    ("writer", "reader", "names"),
    [(px4, qgroundcontrol, PX4_NAMES), (ardupilot, mavproxy, ARDUPILOT_NAMES)],
    ids=["px4", "ardupilot"],
)


def read_of(triad: Triad, truth: Array) -> Array:
    """What three sensors read of a truth, (n, 3)."""
    return np.asarray(truth @ triad.matrix.T + triad.bias)


@AUTOPILOTS
def test_applied_as_the_autopilot_does_it_leaves_what_the_file_states(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    text = writer(calibration())
    values = reader(text)
    offset, scale, turn = ([values[name.format(axis)] for axis in "XYZ"] for name in names)
    assert len(values) == 9
    whole = mount()
    for sensor, triad, parts in (
        ("accelerometer", whole.accelerometer, (offset, scale)),
        ("gyro", whole.gyroscope, (turn, None)),
    ):
        truth = probes(sensor)
        reading = read_of(triad, truth)
        exact = (reading - triad.bias) @ np.linalg.inv(triad.matrix).T
        assert exact == pytest.approx(truth, abs=1e-12)
        left = np.abs(corrected(reading, *parts) - exact).max(axis=0)
        assert left == pytest.approx(remaining(text, sensor), rel=5e-3)  # to three digits
        before = np.abs(reading - exact).max(axis=0)
        assert (left < before).all()


@AUTOPILOTS
def test_along_its_own_axis_an_accelerometer_is_right(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    values = reader(writer(calibration()))
    offset, scale, _ = ([values[name.format(axis)] for axis in "XYZ"] for name in names)
    truth = 9.8 * np.eye(3)
    taken = corrected(read_of(mount().accelerometer, truth), offset, scale)
    assert np.diag(taken) == pytest.approx([9.8] * 3, abs=2e-6)  # single precision


@AUTOPILOTS
def test_what_was_not_determined_is_left_out_and_named(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    missing = {"accelerometer": ["bias_x", "scale_y", "cross_zx"], "gyroscope": ["bias_z"]}
    text = writer(calibration(mount(missing=missing)))
    values = reader(text)
    gone = {names[0].format("X"), names[1].format("Y"), names[2].format("Z")}
    every = {name.format(axis) for name in names for axis in "XYZ"}
    assert set(values) == every - gone
    prose = " ".join(text.replace("\n#", "").split())
    (named_left,) = re.findall(rf"Left out: - ([\w, ]+): {REASON.replace('°', ' deg')}", prose)
    assert set(named_left.split(", ")) == gone
    assert np.isnan(remaining(text, "accelerometer")).all()
    assert np.isnan(remaining(text, "gyro")).tolist() == [False, False, True]
    assert "z accelerometer: not known, because cross_zx was not determined" in prose


@AUTOPILOTS
def test_a_sensor_that_reads_the_other_way_round_gets_no_scale_factor(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    turned = mount()
    turned.accelerometer.matrix[1] *= -1
    text = writer(calibration(turned))
    assert names[1].format("Y") not in reader(text)
    assert "reads the other way round" in " ".join(text.replace("\n#", "").split())


@AUTOPILOTS
def test_of_several_mounts_the_one_that_determines_most_is_taken_and_named(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    first = mount("upright", {"gyroscope": ["bias_z", "scale_z"]})
    text = writer(calibration(first, mount("on its side")))
    assert names[2].format("Z") in reader(text)
    prose = " ".join(text.replace("\n#", "").split())
    assert 'accelerometer "upright", gyroscope "on its side"' in prose


@AUTOPILOTS
def test_a_compensated_campaign_exports_nothing_but_says_why(
    writer: Writer, reader: Reader, names: tuple[str, str, str]
) -> None:
    text = writer(nothing())
    assert reader(text) == {}
    assert "Nothing is exported. It was compensated." in text


def nothing() -> Calibration:
    whole = calibration()
    return Calibration(whole.campaign, (), USE, not_exported="It was compensated.")


# ---- Kalibr

KEYS = {  # ConfigReader.py, class ImuParameters
    "rostopic",
    "update_rate",
    "accelerometer_noise_density",
    "accelerometer_random_walk",
    "gyroscope_noise_density",
    "gyroscope_random_walk",
}
UNKNOWN = {"rostopic", "accelerometer_random_walk", "gyroscope_random_walk"}


def test_kalibr_gets_rate_and_noise_and_the_file_says_what_is_missing() -> None:
    text = imu_yaml(calibration())
    values = yaml.safe_load(text)  # as Kalibr does
    assert set(values) == KEYS - UNKNOWN
    assert all(isinstance(value, float) and value > 0 for value in values.values())
    assert values["update_rate"] == 100.0
    # The noisiest axis, and what the sigmas of the calibration add to it.
    assert 1 < values["accelerometer_noise_density"] / (1.2 * 1.05e-4) < 2
    assert 1 < values["gyroscope_noise_density"] / (1.2 * 3.4e-6) < 2
    for key in UNKNOWN:
        assert f"# {key}:\n" in text


def test_filled_in_where_it_says_so_kalibr_has_all_it_insists_on() -> None:
    text = imu_yaml(calibration())
    for key in UNKNOWN:
        text = text.replace(f"# {key}:\n", f"{key}: 1.0\n")
    assert set(yaml.safe_load(text)) == KEYS


def test_kalibr_leaves_the_whole_error_and_states_it() -> None:
    text, whole = imu_yaml(calibration()), mount()
    for sensor, triad in (("accelerometer", whole.accelerometer), ("gyro", whole.gyroscope)):
        left = np.abs(read_of(triad, probes(sensor)) - probes(sensor)).max(axis=0)
        assert left == pytest.approx(remaining(text, sensor), rel=5e-3)
    for number in ("-0.0523", "+3000", "+0.0075", "-2.1e-05"):
        assert number in text


def test_without_noise_and_time_kalibr_gets_nothing_and_the_file_says_so() -> None:
    whole = calibration(rate=None)
    text = imu_yaml(Calibration(**vars(whole) | {"noise": [], "rate": None}))
    assert yaml.safe_load(text) is None
    for key in KEYS:
        assert f"# {key}:\n" in text


def test_kalibr_gets_nothing_of_a_compensated_campaign() -> None:
    text = imu_yaml(nothing())
    assert yaml.safe_load(text) is None
    assert "Nothing is exported. It was compensated." in text


# ---- names from outside


@pytest.mark.parametrize("name", EVIL)
def test_a_name_from_outside_is_a_comment_and_no_parameter(name: str) -> None:
    odd = named(name)
    for writer, reader in ((px4, qgroundcontrol), (ardupilot, mavproxy)):
        text = writer(odd)
        assert text.isascii()
        assert len(reader(text)) == 9  # of both mounts the whole one
        assert all(sign.isprintable() or sign in "\n\t" for sign in text)
        numbers = ("CAL_", "EKF2_")
        prose = [line for line in text.splitlines() if not any(name in line for name in numbers)]
        assert all("\t" not in line for line in prose)
    text = imu_yaml(odd)
    assert text.isascii()
    assert set(yaml.safe_load(text)) == KEYS - UNKNOWN
