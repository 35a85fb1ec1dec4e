"""A scale factor of the gyros that goes with the temperature."""

from inertial.arrays import Array
from inertial.physics.drift import OfTemperature, warmer
from inertial.physics.effect import Reading, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.physics.motion import Motion
from inertial.text.messages import _


class GyroScaleTemperature(OfTemperature):
    """ω̃_i += k_i (T − mean of T) ω_i.

    Told from a bias that goes with temperature by turns both ways at several temperatures.
    """

    name = "gyro_scale_temperature"
    cause = _("the scale factor of the gyros changes with the temperature of the instrument")
    source = "IEEE Std 952-1997, model equation, terms of temperature"
    parameters = parameters_by_axis("k", "1/K", 1e-5, _("of the {axis} gyro, per kelvin"))
    terms = on_each_axis("gyro", "k_{i}", "(T - T0) * w_{i}")
    sizes = by_grade(1e-6, 5, 10, 50, 200)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        change = values * truth.rate * warmer(motion, self.reference, self.valid)[:, None]
        return reading.plus("gyro", change)
