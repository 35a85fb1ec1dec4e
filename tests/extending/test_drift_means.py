"""What drifts change the parameters of a sensor by: bias or matrix, by their course."""

import numpy as np
import pytest

from inertial.effects import CATALOGUE
from inertial.effects.temperature_model import Piece, TemperatureModel
from inertial.estimation.triad import linear_names
from inertial.physics.motion import stretches
from stages.extension.estimates import DRIFTS, changes_of

TIME = np.array([10.0, 110.0, 410.0])
KELVIN = np.array([290.0, 293.0, 299.0])
MOTION = stretches(TIME, np.full(3, 20.0), KELVIN)


@pytest.mark.parametrize(
    ("effect", "number", "of", "course"),
    [
        (CATALOGUE["gyro_bias_ramp"], 1, "bias_y", TIME),
        (CATALOGUE["gyro_scale_ramp"], 0, "scale_x", TIME),
        (CATALOGUE["gyro_bias_jump"].fixed(60.0), 2, "bias_z", TIME > 60),
        (CATALOGUE["gyro_scale_jump"].fixed(60.0), 1, "scale_y", TIME > 60),
        (CATALOGUE["gyro_bias_temperature"], 0, "bias_x", KELVIN - KELVIN.mean()),
        (CATALOGUE["gyro_warm_up"].fixed(200.0), 2, "bias_z", None),
        (TemperatureModel("gyro", [Piece("cross_xy", 1)]), 0, "cross_xy", KELVIN - KELVIN.mean()),
    ],
)
def test_a_drift_changes_one_parameter_by_its_course(effect, number, of, course):
    unit = np.eye(len(effect.parameters))[number]
    changes = changes_of(effect, unit, MOTION, "gyro")
    place = list(linear_names()).index(of)
    if course is None:  # its mean over a stretch from t − 10 to t + 10, τ = 200 s
        ends = np.array([TIME - 10, TIME + 10])
        course = -200 * np.diff(np.exp(-ends / 200), axis=0)[0] / 20
    np.testing.assert_allclose(changes[:, place], course, rtol=1e-6, atol=1e-9)
    assert not np.delete(changes, place, axis=1).any()


def test_what_turns_the_case_is_no_drift_of_the_sensor():
    """Models with it and without differ in M, which is that of the case before it."""
    assert not isinstance(CATALOGUE["mounting_shift"], DRIFTS)
    assert not isinstance(CATALOGUE["mounting_slip"], DRIFTS)
