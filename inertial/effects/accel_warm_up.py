"""A bias of the accelerometers that settles after the instrument is switched on."""

from inertial.physics.drift import WarmUp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelWarmUp(WarmUp):
    """As `WarmUp`, of the accelerometers."""

    name = "accel_warm_up"
    sensor = "accel"
    parameters = parameters_by_axis(
        "b",
        "m/s²",
        1e-5 * STANDARD_GRAVITY,
        _("further bias of the {axis} accelerometer at the first sample"),
    )
    terms = on_each_axis("accel", "b_{i}", "exp(-t / tau)")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 100, 1000)
