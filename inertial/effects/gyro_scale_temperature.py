"""A scale factor of the gyros that goes with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class GyroScaleTemperature(OfTemperature):
    """ω̃_i += k_i (T − mean of T) ω_i.

    Told from a bias that goes with temperature by turns both ways at several temperatures.
    """

    name = "gyro_scale_temperature"
    sensor = "gyro"
    of_scale = True
    cause = _("the scale factor of the gyros changes with the temperature of the instrument")
    source = "IEEE Std 952-1997, model equation, terms of temperature"
    parameters = parameters_by_axis(
        "k", "1/K", 1e-5, _("change of the scale factor of the {axis} gyro with temperature")
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "(T - T0) * s_{i}")
    sizes = by_grade(1e-6, 5, 10, 50, 200)
