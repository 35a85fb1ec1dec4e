"""Dead band of a gyro."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR


class GyroDeadBand(ArrayEffect):
    """The output of gyro i is zero while |ω_i| is below a width: lock-in.

    It acts on the rate along the gyro's axis, M ω; bias and noise are added afterwards.
    value: (3,), rad/s. Source: IEEE Std 528-2019, "dead band".
    """

    KEY = "width_deg_h"
    UNIT = DEGREE / HOUR

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        return Reading.of_gyros(np.where(np.abs(rate) < self.value, -rate, 0.0))
