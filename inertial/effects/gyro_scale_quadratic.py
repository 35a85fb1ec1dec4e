"""A gyro whose scale factor grows with the rate."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE


class GyroScaleQuadratic(OfSensed):
    """ω̃_i += k_i ω_i |ω_i|.

    Told from the scale factor by turns at two rates, from the cubic term by three: while the table
    turns, its angle within a turn is not known by itself, so one rate shows neither.
    """

    name = "gyro_scale_quadratic"
    sensor = "gyro"
    cause = _("the loop or the read-out of the gyro is not linear in the rate")
    source = "IEEE Std 528-2019, 'nonlinearity'"
    parameters = parameters_by_axis(
        "k",
        "1/(rad/s)",
        1e-6 / DEGREE,
        _("change of the scale factor of the {axis} gyro per magnitude of its rate"),
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "s_{i} * abs(s_{i})")
    sizes = by_grade(1e-6 / DEGREE, 0.1, 0.1, 1, 5)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.rate * np.abs(truth.rate)
