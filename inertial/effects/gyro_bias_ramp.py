"""A bias of the gyros that drifts evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, HOUR


class GyroBiasRamp(Ramp):
    """Reading += c t, with t since the first sample of all logs.

    Told from a constant by the order of the positions. Only logs with a common clock show it.
    """

    name = "gyro_bias_ramp"
    sensor = "gyro"
    cause = _("the bias of the gyros drifts, as the sensor or its electronics warm up or age")
    source = "IEEE Std 952-1997, annex C, rate ramp"
    parameters = parameters_by_axis(
        "c", "rad/s²", 0.1 * DEGREE_PER_HOUR / HOUR, _("drift of the bias of the {axis} gyro")
    )
    terms = on_each_axis("gyro", "c_{i}", "t")
    sizes = by_grade(DEGREE_PER_HOUR / HOUR, 0.05, 1, 10, 100)
