"""Hysteresis of the accelerometers: a bias that depends on the previous orientation."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import last_sign
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY

MIN_VERTICAL_FORCE = 0.5 * STANDARD_GRAVITY  # m/s², of an axis that points up or down


@dataclass
class AccelHysteresis(ArrayEffect):
    """f̃_i += h_i s_i (1 − |f_i|/g), s_i the sign of the force when axis i last pointed up or down.

    A loop that is closed at 1 g up and down, and widest where the axis is horizontal: there the
    error still has the sign of the previous orientation. s is 0 before the first.
    value: h, (3,), m/s².
    Source: IEEE Std 528-2019, "hysteresis error".
    """

    KEY = "offset_micro_g"
    UNIT = MICROGRAVITY

    _sign: Array = field(default_factory=lambda: np.zeros(3), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        signs = last_sign(force, MIN_VERTICAL_FORCE, self._sign)
        self._sign = signs[-1]
        width = np.clip(1 - np.abs(force) / STANDARD_GRAVITY, 0.0, None)
        return Reading.of_accelerometers(signs * width * self.value)
