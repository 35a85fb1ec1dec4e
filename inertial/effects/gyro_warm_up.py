"""A bias of the gyros that settles after the instrument is switched on."""

from inertial.physics.drift import WarmUp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


class GyroWarmUp(WarmUp):
    """As `WarmUp`, of the gyros."""

    name = "gyro_warm_up"
    sensor = "gyro"
    parameters = parameters_by_axis(
        "b", "rad/s", DEGREE_PER_HOUR, _("further bias of the {axis} gyro at the first sample")
    )
    terms = on_each_axis("gyro", "b_{i}", "exp(-t / tau)")
    sizes = by_grade(DEGREE_PER_HOUR, 0.3, 5, 30, 300)
