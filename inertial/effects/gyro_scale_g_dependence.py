"""A gyro whose scale factor depends on the acceleration."""

from inertial.arrays import Array
from inertial.physics.effect import OfSensed, Truth, by_grade, on_each_axis, parameters_by_axis
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY


class GyroScaleGDependence(OfSensed):
    """ω̃_i += k_i ω_i f_i.

    Told from the scale factor by turns about the axis up and down, at the same rate: at another
    rate a nonlinear scale factor does the same.
    """

    name = "gyro_scale_g_dependence"
    sensor = "gyro"
    cause = _("load on the sensing element changes what a rate does to it")
    source = "Sensonor, STIM300 data sheet, linear acceleration effect on the scale factor"
    parameters = parameters_by_axis(
        "k",
        "1/(m/s²)",
        1e-4 / STANDARD_GRAVITY,
        _("change of the scale factor of the {axis} gyro per force along it"),
    )
    own_axis = "gyro"
    terms = on_each_axis("gyro", "k_{i}", "s_{i} * f_{i}")
    sizes = by_grade(1e-6 / STANDARD_GRAVITY, 2, 30, 100, 500)

    def change(self, truth: Truth, values: Array) -> Array:
        return values * truth.rate * truth.force
