"""Biases of a sensor that drift evenly."""

from inertial.physics.drift import Ramp
from inertial.physics.effect import OfSensor, by_grade
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, HOUR, STANDARD_GRAVITY


class BiasRamp(Ramp):
    """Reading += c t, with t since the first sample of all logs.

    Told from a constant by the order of the positions. Only logs with a common clock show it.
    """

    kind, letter, factor = "bias_ramp", "c", "t"
    gyro = OfSensor(
        _("drift of the bias of the {axis} gyro"),
        "rad/s²",
        0.1 * DEGREE_PER_HOUR / HOUR,
        by_grade(DEGREE_PER_HOUR / HOUR, 0.05, 1, 10, 100),
        _("the bias of the gyros drifts, as the sensor or its electronics warm up or age"),
        "IEEE Std 952-1997, annex C, rate ramp",
    )
    accel = OfSensor(
        _("drift of the bias of the {axis} accelerometer"),
        "m/s³",
        1e-5 * STANDARD_GRAVITY / HOUR,
        by_grade(1e-6 * STANDARD_GRAVITY / HOUR, 20, 100, 100, 1000),
        _("the bias of the accelerometers drifts, as the sensor or its electronics warm up or age"),
        "IEEE Std 1554-2005, 'ramp' of the Allan variance",
    )
