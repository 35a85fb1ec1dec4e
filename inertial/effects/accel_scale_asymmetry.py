"""An accelerometer whose scale factor differs between the two senses of the force."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _


class AccelScaleAsymmetry(OfSensed):
    """f̃_i += A_i |f_i|.

    Told from a bias as the quadratic term is, and from that only by oblique positions.
    """

    name = "accel_scale_asymmetry"
    sensor = "accel"
    cause = _("the suspension or the read-out answers unlike to push and pull")
    source = "IEEE Std 1293-2018, model equation, scale factor asymmetry"
    parameters = parameters_by_axis(
        "a",
        "1",
        1e-5,
        _("half the difference of the scale factors of the {axis} accelerometer for both senses"),
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "a_{i}", "abs(s_{i})")
    sizes = by_grade(1e-6, 10, 50, 100, 500)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * np.abs(truth.force)
