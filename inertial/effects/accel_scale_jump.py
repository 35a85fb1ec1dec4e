"""Scale factors of the accelerometers that jump once."""

from inertial.physics.drift import ScaleJump
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class AccelScaleJump(ScaleJump):
    """As `ScaleJump`, of the accelerometers."""

    name = "accel_scale_jump"
    sensor = "accel"
    parameters = parameters_by_axis(
        "k", "1", 1e-5, _("jump of the scale factor of the {axis} accelerometer")
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "k_{i}", "(t > t0) * s_{i}")
    sizes = by_grade(1e-6, 50, 200, 500, 1000)
