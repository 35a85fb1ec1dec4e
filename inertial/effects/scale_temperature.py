"""Scale factors of a sensor that go with the temperature."""

from inertial.physics.drift import OfTemperature
from inertial.physics.effect import OfSensor, by_grade
from inertial.text.messages import _


class ScaleTemperature(OfTemperature):
    """ω̃_i += k_i (T − mean of T) ω_i, f̃_i += k_i (T − mean of T) f_i.

    Told from a bias that goes with temperature by turns both ways, or by the axis up and down, at
    several temperatures.
    """

    kind, letter, factor = "scale_temperature", "k", "(T - T0) * s_{i}"
    of_scale = True
    gyro = OfSensor(
        _("change of the scale factor of the {axis} gyro with temperature"),
        "1/K",
        1e-5,
        by_grade(1e-6, 5, 10, 50, 200),
        _("the scale factor of the gyros changes with the temperature of the instrument"),
        "IEEE Std 952-1997, model equation, terms of temperature",
    )
    accel = OfSensor(
        _("change of the scale factor of the {axis} accelerometer with temperature"),
        "1/K",
        1e-5,
        by_grade(1e-6, 5, 20, 50, 200),
        _("the scale factor of the accelerometers changes with the temperature of the instrument"),
        "IEEE Std 1293-2018, temperature sensitivity of bias and scale factor",
    )
