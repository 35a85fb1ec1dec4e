"""A bias of the gyros that goes with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR


class GyroBiasTemperature(OfTemperature):
    """Reading += k (T − mean of T).

    Told from a drift by temperature that does not run with time.
    """

    name = "gyro_bias_temperature"
    sensor = "gyro"
    cause = _("the bias of the gyros changes with the temperature of the instrument")
    source = "IEEE Std 952-1997, model equation, terms of temperature"
    parameters = parameters_by_axis(
        "k",
        "rad/s/K",
        0.1 * DEGREE_PER_HOUR,
        _("change of the bias of the {axis} gyro with temperature"),
    )
    terms = on_each_axis("gyro", "k_{i}", "(T - T0)")
    sizes = by_grade(DEGREE_PER_HOUR, 0.05, 1, 5, 18)
