"""A scale factor of the gyros that drifts evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import HOUR


class GyroScaleRamp(Ramp):
    """ω̃_i += k_i t ω_i, with t since the first sample of all logs.

    Shown by turns about one axis at several times. Where the temperature rises all the time it is
    not told from the temperature; a bias that drifts is the same in turns of both directions.
    """

    name = "gyro_scale_ramp"
    sensor = "gyro"
    of_scale = True
    cause = _("the scale factor of the gyros drifts, as the sensor warms up or ages")
    source = "IEEE Std 952-1997, scale factor errors: instability"
    parameters = parameters_by_axis(
        "k", "1/s", 1e-5 / HOUR, _("drift of the scale factor of the {axis} gyro")
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "t * s_{i}")
    sizes = by_grade(1e-6 / HOUR, 5, 20, 100, 500)
    thinkable = 4.0  # 200 ppm/K that warms by 10 K in an hour
