"""The rests of a tumble share how its axis leans and how the case stands on it.

Readings are made here of tumbles about y, z and x in steps of 45°, there and back. Of each the axis
leans by an angle that is fixed to the laboratory, all angles are off by the same, and the case is
off about two directions of its own; each rest has a tilt of its own beside it.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inertial.campaign.records import Manoeuvre
from inertial.campaign.static_positions import tumble_tilts
from inertial.estimation.accelerometers import Reference, StaticForce, fit

GRAVITY, NOISE, POSITION_SIGMA = 9.8, 5e-5, np.radians(5 / 3600)
STEPS = [*range(8), *range(7, -1, -1)]
DRAWS = 24


def rest(name: str, up: np.ndarray, axis: np.ndarray, angle: float) -> Manoeuvre:
    of_log = {"log": "", "mount": "", "mark": None, "recorded": "whole", "label": None}
    no_turn = dict.fromkeys(["about", "angle", "angle_sigma", "rate", "acceleration", "seconds"])
    no_span = dict.fromkeys(["from_s", "to_s", "from_row", "to_row"])
    own = {"tumble": name, "tumble_axis": axis, "tumbled": angle * axis}
    return Manoeuvre(name, "rest", position=name, up=up, **of_log, **no_turn, **no_span, **own)


def readings(random: np.random.Generator) -> tuple[list[StaticForce], np.ndarray]:
    """Means, and M and the bias that are drawn."""
    matrix, bias = np.eye(3) + random.normal(0, 1e-3, (3, 3)), random.normal(0, 0.01, 3)
    statics = []

    def turned(*axes: np.ndarray) -> Rotation:
        angles = random.normal(0, POSITION_SIGMA, len(axes))
        return Rotation.from_rotvec(angles @ np.array(axes))

    for i in range(3):
        start, axis = np.eye(3)[i], np.eye(3)[i - 1]
        leans = turned(np.cross(axis, start))
        stands = turned(axis) * turned(start, np.cross(axis, start))
        for number, step in enumerate(STEPS):
            on = Rotation.from_rotvec(-step * np.pi / 4 * axis)
            m = rest(f"{i}", on.apply(start), axis, step * np.pi / 4)
            actual = turned(*np.eye(3)) * stands * on * leans
            mean = GRAVITY * matrix @ actual.apply(start) + bias + random.normal(0, NOISE, 3)
            known = {"sigma": np.full(3, NOISE), "tumble_tilts": tumble_tilts(m)}
            statics.append(StaticForce(f"{i} {number}", m.up, mean, **known))
    return statics, np.append(matrix.ravel(), bias)


@pytest.fixture(scope="module")
def draws():
    return [readings(np.random.default_rng(seed)) for seed in range(DRAWS)]


def rms_of_pulls(draws, change=lambda static: static) -> tuple[float, float]:
    """Of M, and of the bias."""
    reference, pulls = Reference(GRAVITY, 1e-6, POSITION_SIGMA), []
    for statics, true in draws:
        estimate = fit([change(static) for static in statics], reference).estimate
        pulls.append((estimate.values[:12] - true) / estimate.sigma[:12])
    matrix, bias = np.split(np.square(pulls), [9], axis=1)
    return float(np.sqrt(matrix.mean())), float(np.sqrt(bias.mean()))


def test_the_truth_comes_back_within_its_sigma(draws):
    matrix, bias = rms_of_pulls(draws)
    assert 0.9 < matrix < 1.1 and 0.85 < bias < 1.15


@pytest.mark.parametrize(
    ("left_out", "matrix", "bias"),
    [("angle", 3.0, 0.0), ("case 0", 1.8, 0.0), ("case 1", 1.8, 0.0), ("lean of axis", 0.0, 1.2)],
)
def test_without_one_of_the_shared_tilts_the_sigmas_are_too_small(draws, left_out, matrix, bias):
    def without(static: StaticForce) -> StaticForce:
        kept = {n: tilt for n, tilt in static.tumble_tilts.items() if left_out not in n}
        return replace(static, tumble_tilts=kept)

    found = rms_of_pulls(draws, without)
    assert found[0] > matrix and found[1] > bias
