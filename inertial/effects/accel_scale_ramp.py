"""A scale factor of the accelerometers that drifts evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import HOUR


class AccelScaleRamp(Ramp):
    """f̃_i += k_i t f_i, with t since the first sample of all logs.

    Told from a bias that drifts by the axis up and down, each at several times. Where the
    temperature rises all the time it is not told from the temperature.
    """

    name = "accel_scale_ramp"
    sensor = "accel"
    of_scale = True
    cause = _("the scale factor of the accelerometers drifts, as the sensor warms up or ages")
    source = "IEEE Std 1293-2018, stability of bias and scale factor"
    parameters = parameters_by_axis(
        "k", "1/s", 1e-5 / HOUR, _("drift of the scale factor of the {axis} accelerometer")
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "k_{i}", "t * s_{i}")
    sizes = by_grade(1e-6 / HOUR, 5, 20, 100, 500)
    thinkable = 4.0  # 200 ppm/K that warms by 10 K in an hour
