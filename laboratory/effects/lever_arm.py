"""An IMU that does not stand on the axis of the table."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.motion import Motion
from laboratory.sensor import Sensors
from laboratory.truth import Pull


class LeverArm(ArrayEffect):
    """f += α × r + ω × (ω × r), ω and α against the ground.

    value: r, (3,), m, from the table's axis to the case's origin, body axes. The integral of α × r
    over a sample is the change of ω times r: exact where the table begins to turn at a jerk.
    """

    KEY = "arm_m"
    UNIT = 1.0

    def pulls(self, motion: Motion, sensors: Sensors) -> Pull:
        centripetal = np.cross(motion.rate, np.cross(motion.rate, self.value))
        return Pull(
            np.cross(motion.acceleration, self.value) + centripetal,
            np.cross(motion.rate_change, self.value) + motion.instants.integral(centripetal),
        )
