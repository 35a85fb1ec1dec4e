"""A scale factor of the gyros that goes with the temperature."""

from dataclasses import replace

from inertial.physics.drift import warmer, without_temperature
from inertial.physics.effect import Array, Effect, Parameter, Reading, Truth, by_grade
from inertial.physics.motion import Motion
from inertial.text.messages import _


class GyroScaleTemperature(Effect):
    """ω̃_i += k_i (T − mean of T) ω_i.

    Told from a bias that goes with temperature by turns both ways at several temperatures.
    """

    name = "gyro_scale_temperature"
    cause = _("the scale factor of the gyros changes with the temperature of the instrument")
    source = "IEEE Std 952-1997, model equation, terms of temperature"
    parameters = tuple(
        Parameter(f"k_{axis}", "1/K", 1e-5, _("of the {axis} gyro, per kelvin", axis=axis))
        for axis in "xyz"
    )
    sizes = by_grade(1e-6, 5, 10, 50, 200)

    def blind(self, motion: Motion) -> str:
        return without_temperature(motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        change = values * truth.rate * warmer(motion)[:, None]
        return replace(reading, gyro=reading.gyro + change)
