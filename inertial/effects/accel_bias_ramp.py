"""A bias of the accelerometers that drifts evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import HOUR, STANDARD_GRAVITY


class AccelBiasRamp(Ramp):
    """Reading += c t, with t since the first sample of all logs.

    Told from a constant by the order of the positions. Only logs with a common clock show it.
    """

    name = "accel_bias_ramp"
    sensor = "accel"
    cause = _(
        "the bias of the accelerometers drifts, as the sensor or its electronics warm up or age"
    )
    source = "IEEE Std 1554-2005, 'ramp' of the Allan variance"
    parameters = parameters_by_axis(
        "c",
        "m/s³",
        1e-5 * STANDARD_GRAVITY / HOUR,
        _("drift of the bias of the {axis} accelerometer"),
    )
    terms = on_each_axis("accel", "c_{i}", "t")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY / HOUR, 20, 100, 100, 1000)
