"""Accelerometer biases that depend on which way up they were last."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import last_sign
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY

LEAST = 0.5 * STANDARD_GRAVITY  # m/s²: beyond it an axis points up or down


@dataclass
class AccelHysteresis(ArrayEffect):
    """f̃_i += h_i s_i (1 − |f_i|/g), s_i the sign of the force when axis i last pointed up or down.

    A loop that is closed at 1 g up and down, and widest where the axis is level: there it still
    reads the side from which it came. s is 0 before it has been on one. offset: h, (3,), m/s².
    Source: IEEE Std 528-2019, "hysteresis error".
    """

    KEY = "offset_micro_g"
    UNIT = MICROGRAVITY

    _sign: Array = field(default_factory=lambda: np.zeros(3), init=False)

    def reads(self, truth: Truth, sensors: Sensors) -> Reading:
        felt = sensors.accelerometer.feels(truth.force)
        signs = last_sign(felt, LEAST, self._sign)
        self._sign = signs[-1]
        width = np.clip(1 - np.abs(felt) / STANDARD_GRAVITY, 0.0, None)
        return Reading.of_accelerometers(signs * width * self.value)
