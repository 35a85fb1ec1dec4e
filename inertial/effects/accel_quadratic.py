"""An accelerometer whose scale factor grows with the force."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelQuadratic(OfSensed):
    """f̃_i += K_i f_i².

    Told from a bias by three positions of an axis: up and down have it, level has not. Without
    oblique positions a scale factor that differs up and down does the same.
    """

    name = "accel_quadratic"
    sensor = "accel"
    cause = _("the suspension of the proof mass is not symmetric: second-order nonlinearity K2")
    source = "IEEE Std 1293-2018, model equation, K2"
    parameters = parameters_by_axis(
        "k2",
        "(m/s²)/(m/s²)²",
        1e-5 / STANDARD_GRAVITY,
        _("reading of the {axis} accelerometer per square of the force along it"),
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "k2_{i}", "s_{i} * s_{i}")
    sizes = by_grade(1e-6 / STANDARD_GRAVITY, 20, 100, 200, 1000)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.force**2
