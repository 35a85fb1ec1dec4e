"""A gyro that feels the square of the acceleration."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import DEGREE_PER_HOUR, STANDARD_GRAVITY

UNIT = DEGREE_PER_HOUR / STANDARD_GRAVITY**2


class GyroG2Sensitivity(OfSensed):
    """ω̃_i += G2_i f_i².

    Told from a bias by three positions of an axis: up and down have it alike, level has it not.
    """

    name = "gyro_g2_sensitivity"
    sensor = "gyro"
    cause = _(
        "the suspension of the gyro yields unlike in its directions under load (anisoelastic)"
    )
    source = "IEEE Std 528-2019, 'acceleration-squared-sensitive drift rate'"
    parameters = parameters_by_axis(
        "g2",
        "(rad/s)/(m/s²)²",
        1.0 * UNIT,
        _("reading of the {axis} gyro per square of the force along it"),
    )
    terms = on_each_axis("gyro", "g2_{i}", "f_{i} * f_{i}")
    sizes = by_grade(UNIT, 0.01, 0.05, 0.5, 5)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.force**2
