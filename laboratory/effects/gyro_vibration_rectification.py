"""Vibration rectification of the gyros."""

from collections.abc import Mapping
from typing import Any, Self

import numpy as np

from laboratory.effects.accel_vibration_rectification import AccelVibrationRectification
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY


class GyroVibrationRectification(AccelVibrationRectification):
    """While the table is shaken, f̃_i += v, and ω̃_i += 3 k_i σ²: a vibration along all three axes.

    coefficient: k, (3,), (rad/s)/(m/s²)²; vibration, start, end: as of the accelerometers.
    Source: Weinberg 2011, Gyro mechanical performance, Analog Devices MS-2158.
    """

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            np.array(parameters["k_deg_h_g2"]) * DEGREE / HOUR / STANDARD_GRAVITY**2,
            parameters["vibration_g"] * STANDARD_GRAVITY,
            parameters["from_s"],
            parameters["to_s"],
        )

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        shift = 3 * self.coefficient * self.vibration**2
        return Reading.of_gyros(self.shaken(truth.motion.instants)[:, None] * shift)
