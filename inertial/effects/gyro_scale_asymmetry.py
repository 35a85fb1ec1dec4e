"""A gyro whose scale factor differs between the two senses of rotation."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class GyroScaleAsymmetry(OfSensed):
    """ω̃_i += A_i |ω_i|.

    Told from the bias by its growth with the rate, from the scale factor by turning both ways: a
    turn forward and one backward do not add up to nothing.
    """

    name = "gyro_scale_asymmetry"
    sensor = "gyro"
    cause = _("the loop or the read-out of the gyro answers unlike to the two senses of rotation")
    source = "IEEE Std 528-2019, 'asymmetry error'"
    parameters = parameters_by_axis(
        "a",
        "1",
        1e-4,
        _("half the difference of the scale factors of the {axis} gyro for both senses"),
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "a_{i}", "abs(s_{i})")
    sizes = by_grade(1e-6, 10, 30, 100, 500)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * np.abs(truth.rate)
