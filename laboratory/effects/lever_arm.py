"""Lever arm from the axis of the table to the IMU."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.motion import Motion
from laboratory.sensor import Sensors
from laboratory.truth import ExtraForce


class LeverArm(ArrayEffect):
    """f += α × r + ω × (ω × r), ω and α against the ground.

    value: r, (3,), m, from the table's axis to the case's origin, body axes. The integral of α × r
    over a sample is the change of ω times r: exact also for a step of the rate.
    """

    KEY = "arm_m"
    UNIT = 1.0

    def extra_force(self, motion: Motion, sensors: Sensors) -> ExtraForce:
        centripetal = np.cross(motion.rate, np.cross(motion.rate, self.value))
        return ExtraForce(
            np.cross(motion.acceleration, self.value) + centripetal,
            np.cross(motion.rate_change, self.value) + motion.instants.integral(centripetal),
        )
