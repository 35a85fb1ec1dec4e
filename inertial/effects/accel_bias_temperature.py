"""A bias of the accelerometers that goes with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelBiasTemperature(OfTemperature):
    """Reading += k (T − mean of T).

    Told from a drift by temperature that does not run with time.
    """

    name = "accel_bias_temperature"
    sensor = "accel"
    cause = _("the bias of the accelerometers changes with the temperature of the instrument")
    source = "IEEE Std 1293-2018, temperature sensitivity of bias and scale factor"
    parameters = parameters_by_axis(
        "k",
        "m/s²/K",
        1e-5 * STANDARD_GRAVITY,
        _("change of the bias of the {axis} accelerometer with temperature"),
    )
    terms = on_each_axis("accel", "k_{i}", "(T - T0)")
    sizes = by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 100, 1000)
