"""An accelerometer with a cubic term."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class AccelCubic(OfSensed):
    """f̃_i += K_i f_i³.

    Only oblique positions tell it from the scale factor: with an axis up, down or level the cube
    of the force is the force.
    """

    name = "accel_cubic"
    sensor = "accel"
    cause = _("the suspension or the loop of the proof mass is not linear: third-order term K3")
    source = "IEEE Std 1293-2018, model equation, K3"
    parameters = parameters_by_axis(
        "k3",
        "(m/s²)/(m/s²)³",
        1e-5 / STANDARD_GRAVITY**2,
        _("reading of the {axis} accelerometer per cube of the force along it"),
    )
    own_axis = "accel"
    terms = on_each_axis("accel", "k3_{i}", "s_{i} * s_{i} * s_{i}")
    sizes = by_grade(1e-6 / STANDARD_GRAVITY**2, 5, 50, 200, 1000)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.force**3
