"""A bias of the gyros that jumps once."""

from inertial.physics.drift import Jump
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


class GyroBiasJump(Jump):
    """As `Jump`, of the gyros."""

    name = "gyro_bias_jump"
    sensor = "gyro"
    parameters = parameters_by_axis(
        "b", "rad/s", DEGREE_PER_HOUR, _("jump of the bias of the {axis} gyro")
    )
    terms = on_each_axis("gyro", "b_{i}", "(t > t0)")
    sizes = by_grade(DEGREE_PER_HOUR, 0.3, 10, 30, 100)
