"""What residuals without a name say by the tilts of positions is evidence of nothing."""

import numpy as np
import pytest

from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.cause import FOUND, UNKNOWN_STRUCTURE
from inertial.model_selection.evidence import Evidence, searched_effect
from inertial.model_selection.naming import causes
from inertial.model_selection.null_simulation import chance
from stages.criticism.selection import Selection

LEVEL, DEGREES = 0.01, 300
JUMP = searched_effect("accel_bias_jump", (0, 1, 2))


def evidence(*, by_gyros: float, by_accelerometers: float, excess: float = 1.0) -> Evidence:
    """χ² falls by so much in either sensor by a jump that changes accelerometers alone."""
    sensors = []
    for drop, times in ((by_gyros, excess), (by_accelerometers, 1.0)):
        right = np.array([np.sqrt(drop), 0.0, 0.0])
        whole = times * DEGREES + drop
        sensors.append(EffectInformation(("x", "y", "z"), np.eye(3), right, whole, DEGREES))
    raw = np.array([np.zeros(3), np.ones(3)])
    return Evidence(tuple(sensors), ("gyro", "accel"), raw=raw)


def named(said: Evidence) -> Selection:
    law = chance(said.total.information, [JUMP], LEVEL, draws=2000)
    return Selection(None, (), said, [JUMP], {"accel_bias_jump": ()}, causes(said, [JUMP], law), ())


@pytest.mark.parametrize(("excess", "expected"), [(1.0, ["accel_bias_jump"]), (4.0, [])])
def test_gyros_whose_residuals_exceed_their_noise_name_no_jump_of_accelerometers(excess, expected):
    found = named(evidence(by_gyros=400.0, by_accelerometers=2.0, excess=excess))
    assert [cause.effect for cause in found.named.causes] == expected


@pytest.mark.parametrize(
    ("by_accelerometers", "verdict"), [(2.0, UNKNOWN_STRUCTURE), (60.0, FOUND)]
)
def test_beside_a_structure_of_the_gyros_it_is_named_by_accelerometers_alone(
    by_accelerometers, verdict
):
    found = named(evidence(by_gyros=60.0, by_accelerometers=by_accelerometers))
    assert [cause.verdict for cause in found.named.causes] == [FOUND]
    (cause,) = found.without_certain_names(["gyro"]).named.causes
    assert cause.verdict == verdict
