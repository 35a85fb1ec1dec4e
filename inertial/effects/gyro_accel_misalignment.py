"""Gyros that are mounted askew to the accelerometers."""

from dataclasses import replace

from inertial.arrays import Array
from inertial.physics.effect import (
    Effect,
    Truth,
    by_grade,
    known_earth,
    parameters_by_axis,
)
from inertial.physics.motion import Motion, cross
from inertial.text.messages import _


class GyroAccelMisalignment(Effect):
    """ω += ω × φ: the triad of the gyros is turned by φ against that of the accelerometers.

    It is the antisymmetric part of the gyros' M against that of the accelerometers' M, and needs
    no parameters of its own.
    """

    name = "gyro_accel_misalignment"
    cause = _("the block of the gyros and that of the accelerometers are not mounted alike")
    source = "Titterton & Weston 2004, mounting misalignment"
    parameters = parameters_by_axis(
        "phi", "rad", 1e-3, _("rotation about {axis} from the case to the gyros")
    )
    sizes = by_grade(1e-3, 1, 1, 1, 10)
    thinkable = 10.0
    absorbed_by = _("the cross terms of the gyros")

    def moves(self, truth: Truth, motion: Motion, values: Array) -> Truth:
        upward, level = known_earth(truth, motion)
        return replace(truth, rate=truth.rate + cross(motion.omega + upward + level, values))
