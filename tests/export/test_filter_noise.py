"""The noise for a filter: what the errors of the calibration add, against errors that are drawn."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import yaml

from stages.export.autopilots import ARDUPILOT, PX4, Autopilot, parameter_file
from stages.export.calibration import PARAMETERS, Calibration, Use
from stages.export.document import as_json, document
from stages.export.filter_noise import FilterNoise, filter_noise
from stages.export.noise_yaml import imu_yaml, ros_yaml
from tests.export.made_up import INSTABILITY, USE, WALK, calibration, mount, with_terms

SCHEMA = json.loads(
    (Path(__file__).parents[2] / "stages/export/calibration.schema.json").read_text("utf-8")
)
DRAWS, STEP = 4000, 0.1
T = USE.seconds
G = 9.80665
KINDS = {"accelerometer": "accel", "gyroscope": "gyro"}


def found(kind: str, whole: Calibration, **more: object) -> list[FilterNoise]:
    return filter_noise(whole.mounts[0].triad(kind), whole.noise, USE, **more)  # type: ignore[arg-type]


def integrals(kind: str, left: tuple[np.ndarray, np.ndarray] | None = None) -> np.ndarray:
    """Integral over T of what the errors of drawn calibrations leave, (DRAWS, 3).

    The motion is drawn step by step with the correlation exp(−t/τ), gravity in any direction.
    """
    generator = np.random.default_rng(11)
    triad = mount().triad(kind)
    rms = USE.rate_rms if kind == "gyroscope" else USE.force_rms
    count = round(T / STEP)
    keep = np.exp(-STEP / USE.correlation)
    truth = rms * generator.normal(size=(DRAWS, 3))
    total = np.zeros((DRAWS, 3))
    for _unused in range(count):
        total += truth * STEP
        truth = keep * truth + rms * np.sqrt(1 - keep**2) * generator.normal(size=(DRAWS, 3))
    if kind == "accelerometer":
        direction = generator.normal(size=(DRAWS, 3))
        total += G * T * direction / np.linalg.norm(direction, axis=1, keepdims=True)
    drawn = generator.multivariate_normal(np.zeros(12), triad.covariance, DRAWS)
    matrix = triad.matrix + drawn[:, :9].reshape(-1, 3, 3)
    bias = triad.bias + drawn[:, 9:]
    reading = np.einsum("nij,nj->ni", matrix, total) + bias * T
    if left is None:
        return np.asarray((reading - triad.bias * T) @ np.linalg.inv(triad.matrix).T - total)
    offset, scale = left
    return np.asarray(scale * (reading - offset * T) - total)


@pytest.mark.parametrize("kind", KINDS)
def test_the_filter_takes_the_variance_of_the_integral_that_drawn_errors_have(kind: str) -> None:
    expected = np.mean(integrals(kind) ** 2, axis=0)
    for one, variance in zip(found(kind, calibration()), expected, strict=True):
        assert one.own_density is not None and one.own_walk is not None
        own = one.own_density**2 * T + one.own_walk**2 * T**3 / 3
        assert own == pytest.approx(variance, rel=0.12)  # 5 sigma of the draw
        assert one.density**2 == pytest.approx(one.measured_density**2 + one.own_density**2)


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_format_cannot_correct_is_in_it(kind: str) -> None:
    triad = mount().triad(kind)
    scale = 1 / np.diag(triad.matrix) if kind == "accelerometer" else np.ones(3)
    left = (triad.bias, scale)
    expected = np.mean(integrals(kind, left) ** 2, axis=0)
    for one, variance in zip(found(kind, calibration(), left=left), expected, strict=True):
        assert one.own_density is not None and one.own_walk is not None
        own = one.own_density**2 * T + one.own_walk**2 * T**3 / 3
        assert own == pytest.approx(variance, rel=0.12)
        assert variance > 100 * np.mean(integrals(kind)[:, 0] ** 2)  # cross terms of 0.75 %


def test_constant_errors_go_to_the_walk_and_moving_ones_to_the_density() -> None:
    """Without motion and gravity, K² T³/3 alone is (σ_b T)²: K = σ_b √(3/T)."""
    triad = mount().gyroscope
    still = Use(T, 0.0, 0.0, 1.0)
    for one, sigma in zip(
        filter_noise(triad, calibration().noise, still), triad.bias_sigma, strict=True
    ):
        assert one.own_density == 0
        assert one.own_walk == pytest.approx(sigma * np.sqrt(3 / T), rel=0.02)


def test_a_walk_that_is_not_detected_is_its_limit_and_a_bias_instability_adds() -> None:
    whole = with_terms(calibration())
    for kind, sensor in KINDS.items():
        (x, _y, z), (own_x, *_unused) = found(kind, whole), found(kind, calibration())
        walk, limit = WALK[sensor]
        measured = limit if walk is None else walk
        assert measured is not None
        assert x.walk_is_limit is (walk is None)
        assert x.measured_walk == pytest.approx(measured)
        assert z.measured_walk == pytest.approx(1.2 * measured)
        # The same Allan deviation at T: K_B² T/3 = 0.4413 B² (IEEE Std 952)
        flicker = 3 * 0.4413 * (INSTABILITY[sensor] or 0.0) ** 2 / T
        assert x.walk is not None and own_x.own_walk is not None
        assert x.walk**2 == pytest.approx(measured**2 + flicker + own_x.own_walk**2, rel=1e-3)


def test_without_terms_there_is_no_walk_and_with_parameters_missing_nothing_is_added() -> None:
    missing = calibration(mount(missing={"gyroscope": ["cross_xy"]}))
    for one in found("gyroscope", missing):
        assert (one.walk, one.measured_walk, one.own_walk, one.own_density) == (None,) * 4
        assert one.density == one.measured_density
    nothing = mount(missing=dict.fromkeys(KINDS, PARAMETERS))
    prose = " ".join(imu_yaml(with_terms(calibration(nothing))).replace("\n#", "").split())
    assert prose.count("the errors of the calibration are not contained for the") == 2
    assert "needs no further factor" not in prose


def test_kalibr_reads_all_keys_but_the_topic_and_the_head_has_both_numbers() -> None:
    whole = with_terms(calibration())
    text = imu_yaml(whole)
    values = yaml.safe_load(text)
    for kind in KINDS:
        noise = found(kind, whole)
        # As ConfigReader.py checks them: positive numbers.
        assert values[f"{kind}_noise_density"] == max(one.density for one in noise) > 0
        assert values[f"{kind}_random_walk"] == max(one.walk or 0 for one in noise) > 0
    assert "# rostopic:\n" in text and "random_walk: left out" not in text
    prose = " ".join(text.replace("\n#", "").split())
    assert "measured x<4e-07, y<4.4e-07, z<4.8e-07; for a filter x=" in prose
    assert "an upper limit (95 %)" in prose
    assert "over T = 60 s" in prose and "density^2 T + walk^2 T^3 / 3" in prose


def test_without_a_long_stretch_the_walk_is_left_out_with_the_cure() -> None:
    prose = " ".join(imu_yaml(calibration()).replace("\n#", "").split())
    assert "gyroscope_random_walk: left out, because it was not measured" in prose
    assert "Record one of an hour or more" in prose
    assert "The errors of the calibration alone are worth" in prose


def test_ros_gets_the_keys_of_kalibr_and_covariances_of_one_message() -> None:
    whole = with_terms(calibration())
    values = yaml.safe_load(ros_yaml(whole))
    kalibr = yaml.safe_load(imu_yaml(whole))
    assert {key: values[key] for key in kalibr} == kalibr
    for kind, key in (
        ("gyroscope", "angular_velocity_covariance"),
        ("accelerometer", "linear_acceleration_covariance"),
    ):
        matrix = np.reshape(values[key], (3, 3))
        assert matrix == pytest.approx(np.diag(np.diag(matrix)))
        # a sample scatters by density √rate, at 100 Hz ten times the density
        assert np.sqrt(np.diag(matrix)) == pytest.approx(
            [10 * o.density for o in found(kind, whole)]
        )
    empty = yaml.safe_load(ros_yaml(Calibration(**vars(whole) | {"noise": [], "rate": None})))
    assert empty == {"update_rate": 100.0}  # of the instrument


@pytest.mark.parametrize(
    ("autopilot", "period", "names"),
    [
        (PX4, 0.01, ("EKF2_GYR_NOISE", "EKF2_GYR_B_NOISE", "EKF2_ACC_NOISE", "EKF2_ACC_B_NOISE")),
        (
            ARDUPILOT,
            0.012,
            ("EK3_GYRO_P_NSE", "EK3_GBIAS_P_NSE", "EK3_ACC_P_NSE", "EK3_ABIAS_P_NSE"),
        ),
    ],
)
def test_the_filter_of_an_autopilot_predicts_the_variances_of_the_noise(
    autopilot: Autopilot, period: float, names: tuple[str, ...]
) -> None:
    """Steps of (number · dt)², as its source adds them, make density² T and walk² T."""
    whole = with_terms(calibration())
    text = parameter_file(whole, autopilot)
    numbers = dict(re.findall(r"# (?:1\t1\t)?(E\w+_NO?I?SE)[\t,]([\d.e-]+)", text))
    assert set(numbers) == set(names)
    steps = T / period
    for kind, density_name, walk_name in (
        ("gyroscope", *names[:2]),
        ("accelerometer", *names[2:]),
    ):
        triad = whole.mounts[0].triad(kind)
        scale = 1 / np.diag(triad.matrix) if kind == "accelerometer" else np.ones(3)
        noise = found(kind, whole, left=(triad.bias, scale))
        angle = steps * (float(numbers[density_name]) * period) ** 2
        bias = steps * (float(numbers[walk_name]) * period) ** 2
        assert angle == pytest.approx(max(one.density for one in noise) ** 2 * T, rel=2e-3)
        assert bias == pytest.approx(max(one.walk or 0.0 for one in noise) ** 2 * T, rel=2e-3)
    assert "at rest on a table" in " ".join(text.replace("\n#", "").split())


def test_the_document_has_values_with_sigma_and_limits_as_limits() -> None:
    content = json.loads(as_json(document(with_terms(calibration()))))
    jsonschema.Draft202012Validator(SCHEMA).validate(content)
    by_channel = {row["channel"]: row for row in content["noise"]}
    terms = {term["term"]: term for term in by_channel["accel_x"]["terms"]}
    assert (terms["random_walk"]["value"], terms["random_walk"]["upper_limit"]) == (None, 4e-7)
    assert terms["bias_instability"]["value"] == 6e-5
    assert terms["bias_instability"]["sigma"] == pytest.approx(6e-6)
    assert terms["bias_instability"]["upper_limit"] is None
    assert by_channel["accel_x"]["for_filter"]["random_walk_by_upper_limit"] is True
    assert by_channel["gyro_x"]["for_filter"]["random_walk_by_upper_limit"] is False
    assert content["filter_use"]["seconds"] == 60
