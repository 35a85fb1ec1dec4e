"""What a time constant, and the moment of a jump, are uncertain by is in the sigmas."""

import sys
from itertools import product
from pathlib import Path

import chain
import numpy as np
import pytest

import laboratory
from inertial.effects import CATALOGUE
from inertial.estimation.least_squares import System
from inertial.estimation.triad import linear_names
from inertial.physics.motion import stretches
from inertial.text.units import ARC_SECOND
from stages.extension.estimates import Solved
from stages.extension.scanned_values import with_scanned_values

sys.path.insert(0, str(Path(__file__).parents[1] / "hidden"))
import hidden_plans

TAU, NOISE = 900.0, 1e-6  # s, rad/s
SIZES = np.array([9e-6, -9e-6, -3e-6])  # rad/s
TIME = np.linspace(5, 1395, 140)
EFFECT = CATALOGUE["gyro_warm_up"].fixed(TAU)
NAMES = [*linear_names(), *(f"gyro_warm_up.b_{axis}" for axis in "xyz")]
LABELS = [f"{EFFECT.label}.b_{axis}" for axis in "xyz"]


def design() -> np.ndarray:
    """Of biases and amplitudes; the other nine parameters are measured by one reading each."""
    columns = np.zeros((9 + 3 * len(TIME), 15))
    columns[:9, :9] = np.eye(9)
    for axis in range(3):
        rows = slice(9 + axis * len(TIME), 9 + (axis + 1) * len(TIME))
        columns[rows, 9 + axis] = 1.0
        columns[rows, 12 + axis] = np.exp(-TIME / TAU)
    return columns


def system(columns, names) -> System:
    sizes = np.full(columns.shape[1], 1.0)
    kinds = ["parameter"] * 12 + ["effect"] * (len(names) - 12)
    nothing = np.zeros(len(columns))
    of = (nothing, np.full(len(columns), NOISE), 0 * sizes, sizes)
    return System(columns, *of, len(names), tuple(zip(kinds, names, strict=True)))


def with_time_constant(further) -> System:
    (effect,) = further
    motion = stretches(TIME, np.full(len(TIME), 1e-3), np.full(len(TIME), 300.0))
    trace = effect.signature(motion).gyro[:, :, 0].T.ravel()
    columns = np.column_stack([design(), np.append(np.zeros(9), trace)])
    made = system(columns, [*linear_names(), *LABELS, f"{effect.label}.tau"])
    made.prior_sigma[-1] = TAU
    return made


def test_they_are_those_of_the_nonlinear_least_squares():
    """By the inverse of the Fisher information, the derivative by τ being b t/τ² exp(−t/τ)."""
    plain = np.linalg.inv(design().T @ design()) * NOISE**2
    sigmas = np.sqrt(np.diag(plain))
    rows = [
        {"parameter": name, "value": value, "sigma": sigma}
        for name, value, sigma in zip(NAMES, [*np.zeros(12), *SIZES], sigmas, strict=True)
    ]
    estimate = system(design(), [*linear_names(), *LABELS]).solve_shared()
    fit = Solved("gyro", rows, plain, estimate, 0.0, [EFFECT.name] * 3)
    found = with_scanned_values(fit, [EFFECT], with_time_constant)
    slope = np.outer(SIZES, TIME / TAU**2 * np.exp(-TIME / TAU)).ravel()
    whole = np.column_stack([design(), np.append(np.zeros(9), slope)])
    information = whole.T @ whole / NOISE**2
    information[-1, -1] += TAU**-2
    scale = np.sqrt(np.diag(information))
    right = np.linalg.inv(information / np.outer(scale, scale)) / np.outer(scale, scale)
    np.testing.assert_allclose(found.covariance, right[:15, :15], rtol=0.02, atol=1e-16)
    ratio = found.rows[9]["sigma"] / rows[9]["sigma"]
    assert ratio == pytest.approx(np.sqrt(right[9, 9] / plain[9, 9]), rel=0.01) and ratio > 1.5


def test_what_is_not_scanned_stays_as_it_is():
    ramp = CATALOGUE["gyro_bias_ramp"]
    fit = Solved("gyro", [], np.zeros((0, 0)), None, 0.0)
    assert with_scanned_values(fit, [ramp], with_time_constant) is fit


@pytest.mark.slow
def test_a_jump_that_may_have_been_in_either_of_two_pauses_leaves_a_scale_factor_open():
    """Half of it before the last pair of faces, with another scale factor, explains as much."""
    document = chain.demo(seed=81)
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [m for m in plan if m["do"] != "turn"]  # z-up, z-down at its end
    jump = -800.0  # µg
    hidden = {"size_micro_g": [400, 2500, jump], "at_s": 1770.0}  # between these two
    document["effects"] = {"accel_bias_jump": hidden}
    recording = laboratory.perform(laboratory.specify(document))
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    found = results["extension/parameters"].query("sensor == 'accel'")
    (method,) = found.loc[found["parameter"] == "accel_bias_jump.t0", "method"]
    scale = found.loc[found["method"] == method].set_index("parameter").loc["scale_z"]
    true = document["truth"]["accelerometer"]["matrix"][2][2] - 1
    assert abs(scale["value"] - true) < 2 * scale["sigma"]
    # 200 ppm are either of the two from their middle.
    assert scale["sigma"] == pytest.approx(abs(jump) / 4 * 1e-6, rel=0.3)
    # Or a bias of either position: the result is the mean over all that it may be.
    result = results["diagnosis/result"].query("sensor == 'accel'").set_index("parameter")
    mean = result.loc["scale_z"]
    assert abs(mean["value"] - true) < 2 * mean["sigma"] and mean["sigma"] > scale["sigma"]


@pytest.mark.slow
def test_what_no_reading_shows_of_a_shift_in_the_fixture_is_in_the_sigmas():
    """In its middle y-up shows no rotation about y; what is left after it takes that for others."""
    document = hidden_plans.stops(seed=11)
    rotation = {"rotation_arcsec": [120.0, -150.0, 140.0], "at_s": 900.0}
    document["effects"] = {"mounting_shift": rotation}
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    assert set(results["diagnosis/verdict"]["verdict"]) == {"usable_within_limits"}
    result = results["diagnosis/result"].set_index(["sensor", "parameter"])
    for sensor, name in (("accel", "accelerometer"), ("gyro", "gyro")):
        truth = np.array(document["truth"][name]["matrix"]) - np.eye(3)
        for (i, one), (j, other) in product(enumerate("xyz"), enumerate("xyz")):
            row = result.loc[sensor, f"scale_{one}" if i == j else f"cross_{one}{other}"]
            assert abs(row["value"] - truth[i, j]) < 4 * row["sigma"]
        thetas = [result.loc[sensor, f"mounting_shift.theta_{axis}"] for axis in "xyz"]
        unseen = max(thetas, key=lambda row: row["sigma"])
        assert abs(unseen["value"]) < unseen["sigma"] / 10  # nothing is known but a size
        assert 100 * ARC_SECOND < unseen["sigma"] < 1000 * ARC_SECOND
