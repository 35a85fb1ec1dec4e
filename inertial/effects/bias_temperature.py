"""Biases of a sensor that go with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import OfSensor, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY


class BiasTemperature(OfTemperature):
    """Reading += k (T − mean of T).

    Told from a drift by temperature that does not run with time.
    """

    kind, letter, factor = "bias_temperature", "k", "(T - T0)"
    gyro = OfSensor(
        _("change of the bias of the {axis} gyro with temperature"),
        "rad/s/K",
        0.1 * DEGREE_PER_HOUR,
        by_grade(DEGREE_PER_HOUR, 0.05, 1, 5, 18),
        _("the bias of the gyros changes with the temperature of the instrument"),
        "IEEE Std 952-1997, model equation, terms of temperature",
    )
    accel = OfSensor(
        _("change of the bias of the {axis} accelerometer with temperature"),
        "m/s²/K",
        1e-5 * STANDARD_GRAVITY,
        by_grade(1e-6 * STANDARD_GRAVITY, 20, 100, 100, 1000),
        _("the bias of the accelerometers changes with the temperature of the instrument"),
        "IEEE Std 1293-2018, temperature sensitivity of bias and scale factor",
    )
