"""An IMU that does not stand on the axis of the table."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import Effect, Truth, by_grade, parameters_by_axis
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _


class LeverArm(Effect):
    """f += α × r + ω × (ω × r), with r from the table's axis to the case's origin.

    Told from a bias by motion: it is there only while the table turns. Of r only the part
    across the axis of the turn is seen.
    """

    name = "lever_arm"
    cause = _("the accelerometers stand beside the axis of the table and feel its rotation")
    source = "IEEE Std 1293-2018, centrifuge and rate table tests"
    parameters = parameters_by_axis(
        "r", "m", 0.01, _("distance from the table's axis to the case, along {axis}")
    )
    sizes = by_grade(1e-3, 30, 30, 30, 30)

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        swing = cross(motion.alpha, values)
        return replace(truth, force=truth.force + swing + motion.pull(values))
