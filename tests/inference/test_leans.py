"""What a set position leans is known by its own readings, and explains none of them."""

from dataclasses import replace

import numpy as np
import pytest

from inertial.model_selection.structure_tests import Conditions, of_attitude
from inertial.physics.laws import functions
from inertial.physics.motion import stretches

FACES = np.repeat(np.vstack([np.eye(3), -np.eye(3)]), 3, axis=0)
LEANS = 3e-5 * np.random.default_rng(1).normal(size=FACES.shape)  # 6 arc seconds


@pytest.mark.parametrize("family", ["power", "odd_power"])
@pytest.mark.parametrize("state", ["own_force", "other_forces", "force_z"])
def test_a_root_of_the_force_is_that_of_the_planned_attitude(family, state):
    """Beside a clipped z it was "power 0.5 of the force", and scale factors 8 sigma off.

    √f is steep at f = 0: 6640 µg of it are 34 µg for 5 arc seconds.
    """
    n = len(FACES)
    motion = stretches(np.arange(n, dtype=float), np.ones(n), np.full(n, 293.0))
    lean, planned = (
        functions(family, state, (0.5,), replace(motion, up=up), 0) for up in (FACES + LEANS, FACES)
    )
    assert lean == pytest.approx(planned, abs=1e-4)
    intended = FACES + 0.1  # 6°, such as nobody sets by chance
    tilted = functions(family, state, (0.5,), replace(motion, up=intended), 0)
    assert np.abs(tilted - planned).max() > 0.2


def test_a_structure_in_the_attitude_is_none_in_the_leans():
    """With one face of z alone, what z leans on the others was all that "attitude" told apart."""
    n = len(FACES)
    known = FACES[:, 2] < 0.5
    nothing = np.zeros(n)
    conditions = Conditions(nothing, nothing, nothing, (FACES + LEANS)[known], nothing)
    (group,) = of_attitude(conditions)
    level = np.abs(FACES[known][:, 2]) < 0.5
    assert np.ptp(group.functions[level][:, 2]) == 0
