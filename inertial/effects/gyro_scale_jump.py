"""Scale factors of the gyros that jump once."""

from inertial.physics.drift import ScaleJump
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class GyroScaleJump(ScaleJump):
    """As `ScaleJump`, of the gyros."""

    name = "gyro_scale_jump"
    sensor = "gyro"
    parameters = parameters_by_axis(
        "k", "1", 1e-5, _("jump of the scale factor of the {axis} gyro")
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "(t > t0) * s_{i}")
    sizes = by_grade(1e-6, 5, 50, 300, 1000)
