"""An accelerometer whose scale factor grows with the force."""

from dataclasses import replace

from stages.model.effect import Array, Effect, Parameter, Reading, Truth
from stages.model.motion import Motion


class AccelQuadratic(Effect):
    """f̃_i += K_i f_i².

    Told from a bias by three positions of an axis: up and down have it, level has not.
    """

    name = "accel_quadratic"
    cause = "the suspension of the proof mass is not symmetric: second-order nonlinearity K2"
    source = "IEEE Std 1293-2018, model equation, K2"
    parameters = tuple(
        # 10 µg per g²
        Parameter(f"k2_{axis}", "(m/s²)/(m/s²)²", 1.02e-6, f"of the {axis} accelerometer")
        for axis in "xyz"
    )

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        return replace(reading, accel=reading.accel + values * truth.force**2)
