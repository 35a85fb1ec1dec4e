"""A scale factor of the accelerometers that goes with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class AccelScaleTemperature(OfTemperature):
    """f̃_i += k_i (T − mean of T) f_i.

    Told from a bias that goes with temperature by the axis up and down at several temperatures.
    """

    name = "accel_scale_temperature"
    sensor = "accel"
    of_scale = True
    cause = _(
        "the scale factor of the accelerometers changes with the temperature of the instrument"
    )
    source = "IEEE Std 1293-2018, temperature sensitivity of bias and scale factor"
    parameters = parameters_by_axis(
        "k",
        "1/K",
        1e-5,
        _("change of the scale factor of the {axis} accelerometer with temperature"),
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "k_{i}", "(T - T0) * s_{i}")
    sizes = by_grade(1e-6, 5, 20, 50, 200)
