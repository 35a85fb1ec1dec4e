"""A gyro whose scale factor grows with the square of the rate."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE


class GyroScaleCubic(OfSensed):
    """ω̃_i += k_i ω_i³.

    Told from the scale factor by turns at two rates, from the quadratic term by three of them.
    """

    name = "gyro_scale_cubic"
    sensor = "gyro"
    cause = _(
        "the loop or the read-out of the gyro is not linear in the rate, alike for both senses"
    )
    source = "IEEE Std 528-2019, 'nonlinearity'"
    parameters = parameters_by_axis(
        "k",
        "s²/rad²",
        1e-8 / DEGREE**2,
        _("change of the scale factor of the {axis} gyro per square of its rate"),
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "s_{i} * s_{i} * s_{i}")
    sizes = by_grade(1e-6 / DEGREE**2, 1e-3, 1e-4, 5e-3, 0.05)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.rate**3
