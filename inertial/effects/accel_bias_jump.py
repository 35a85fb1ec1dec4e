"""A bias of the accelerometers that jumps once."""

from inertial.physics.drift import Jump
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelBiasJump(Jump):
    """As `Jump`, of the accelerometers."""

    name = "accel_bias_jump"
    sensor = "accel"
    parameters = parameters_by_axis(
        "b", "m/s²", 1e-5 * STANDARD_GRAVITY, _("jump of the bias of the {axis} accelerometer")
    )
    terms = on_each_axis("accel", "b_{i}", "(t > t0)")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 200, 1000)
