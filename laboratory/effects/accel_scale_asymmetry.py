"""Scale factor asymmetry of an accelerometer."""

import numpy as np

from laboratory.effects.effect import ArrayEffect
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


class AccelScaleAsymmetry(ArrayEffect):
    """f̃_i += A_i |f_i|, f_i the specific force along the axis of sensor i.

    value: A, (3,), 1. Source: IEEE Std 1293-2018, model equation, scale factor asymmetry.
    """

    KEY = "asymmetry_micro_g_g"
    UNIT = MICROGRAVITY / STANDARD_GRAVITY

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        return Reading.of_accelerometers(self.value * np.abs(force))
