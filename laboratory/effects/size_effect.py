"""Size effect: accelerometers at different points of the case."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.motion import Motion
from laboratory.sensor import Sensors
from laboratory.truth import ExtraForce


class SizeEffect(ArrayEffect):
    """Accelerometer i senses α × r_i + ω × (ω × r_i) at its own point r_i.

    value: r, (3, 3), m, row = accelerometer, from the case's origin, body axes; a lever arm is
    added. Each reads its own row of M times the force at its own point; the extra force is that
    which gives these three readings.
    """

    KEY = "arms_mm"
    UNIT = 1e-3

    def extra_force(self, motion: Motion, sensors: Sensors) -> ExtraForce:
        matrix = sensors.accelerometer.matrix
        force, velocity = np.zeros_like(motion.rate), np.zeros_like(motion.rate_change)
        for sensor, arm in enumerate(self.value):
            centripetal = np.cross(motion.rate, np.cross(motion.rate, arm))
            tangential = np.cross(motion.acceleration, arm)
            gained = np.cross(motion.rate_change, arm) + motion.instants.integral(centripetal)
            force[:, sensor] = (tangential + centripetal) @ matrix[sensor]
            velocity[:, sensor] = gained @ matrix[sensor]
        read_back = np.linalg.inv(matrix).T
        return ExtraForce(force @ read_back, velocity @ read_back)
