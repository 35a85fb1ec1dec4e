"""Accelerometers that do not stand in one point."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.motion import Motion
from laboratory.sensor import Sensors
from laboratory.truth import Pull


class SizeEffect(ArrayEffect):
    """Accelerometer i feels α × r_i + ω × (ω × r_i) of its own place r_i.

    value: r, (3, 3), m, row = accelerometer, from the case's origin, body axes; a lever arm comes
    on top. Each reads its own row of M times the force at its own place; the pull is what gives
    these three readings.
    """

    KEY = "arms_mm"
    UNIT = 1e-3

    def pulls(self, motion: Motion, sensors: Sensors) -> Pull:
        matrix = sensors.accelerometer.matrix
        force, velocity = np.zeros_like(motion.rate), np.zeros_like(motion.rate_change)
        for sensor, arm in enumerate(self.value):
            centripetal = np.cross(motion.rate, np.cross(motion.rate, arm))
            tangential = np.cross(motion.acceleration, arm)
            gained = np.cross(motion.rate_change, arm) + motion.instants.integral(centripetal)
            force[:, sensor] = (tangential + centripetal) @ matrix[sensor]
            velocity[:, sensor] = gained @ matrix[sensor]
        read_back = np.linalg.inv(matrix).T
        return Pull(force @ read_back, velocity @ read_back)
