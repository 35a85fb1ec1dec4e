"""An IMU that does not stand on the axis of the table."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.motion import Motion
from laboratory.sensor import Sensors
from laboratory.truth import Pull


@dataclass(frozen=True)
class LeverArm(Effect):
    """f += α × r + ω × (ω × r), ω and α against the ground.

    arm: r, (3,), m, from the table's axis to the case's origin, body axes. The integral of α × r
    over a sample is the change of ω times r: exact where the table begins to turn at a jerk.
    """

    arm: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(np.array(parameters["arm_m"], dtype=float))

    def pulls(self, motion: Motion, sensors: Sensors) -> Pull:
        centripetal = np.cross(motion.rate, np.cross(motion.rate, self.arm))
        return Pull(
            np.cross(motion.acceleration, self.arm) + centripetal,
            np.cross(motion.rate_change, self.arm) + motion.instants.integral(centripetal),
        )
