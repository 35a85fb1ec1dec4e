"""Scale factors of a sensor that differ between the two senses of what it senses."""

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import OfEither, OfSensed, OfSensor, Truth, by_grade
from inertial.text.messages import _


class ScaleAsymmetry(OfEither, OfSensed):
    """ω̃_i += A_i |ω_i|, f̃_i += A_i |f_i|.

    Of a gyro told from the bias by its growth with the rate, from the scale factor by turning both
    ways: a turn forward and one backward do not add up to nothing. Of an accelerometer told from a
    bias as the quadratic term is, and from that only by oblique positions.
    """

    kind, letter, factor = "scale_asymmetry", "a", "abs(s_{i})"
    gyro = OfSensor(
        _("half the difference of the scale factors of the {axis} gyro for both senses"),
        "1",
        1e-4,
        by_grade(1e-6, 10, 30, 100, 500),
        _("the loop or the read-out of the gyro answers unlike to the two senses of rotation"),
        "IEEE Std 528-2019, 'asymmetry error'",
    )
    accel = OfSensor(
        _("half the difference of the scale factors of the {axis} accelerometer for both senses"),
        "1",
        1e-5,
        by_grade(1e-6, 10, 50, 100, 500),
        _("the suspension or the read-out answers unlike to push and pull"),
        "IEEE Std 1293-2018, model equation, scale factor asymmetry",
    )

    def change(self, truth: Truth, values: Array) -> Array:
        return values * np.abs(truth.rate if self.sensor == "gyro" else truth.force)
