"""Gravity that is not what it is taken to be."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Truth, usually
from inertial.physics.motion import Motion
from inertial.text.messages import _


class GravityError(Effect):
    """f += Δg up.

    A scale factor that all accelerometers have in common. Nothing in the campaign tells them
    apart: it takes a gravimeter, or a map of gravity.
    """

    name = "gravity_error"
    cause = _("gravity at the site was taken from a formula, or of another place or height")
    source = "Heiskanen & Moritz 1967, Physical Geodesy, gravity anomalies"
    parameters = (Parameter("dg", "m/s²", 5e-5, _("true gravity less the one that is known")),)
    sizes = usually(5e-5)  # 5 mGal
    absorbed_by = _("the scale factors of the accelerometers")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        return replace(truth, force=truth.force + values[0] * motion.up)
