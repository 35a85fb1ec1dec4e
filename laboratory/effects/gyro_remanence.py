"""Gyros that remember the last force along their axis."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import play
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, STANDARD_GRAVITY

HALF_WIDTH = 0.9 * STANDARD_GRAVITY  # m/s², of the play


@dataclass
class GyroRemanence(ArrayEffect):
    """ω̃_i += h_i p(f_i) / (g − w), p the play operator of half width w = 0.9 g.

    A mount that sticks keeps the strain of the last attitude: +h after +g, −h after −g, and what
    it was between. At first it is relaxed.
    value: h, (3,), rad/s.
    """

    KEY = "offset_deg_h"
    UNIT = DEGREE / HOUR

    _played: Array = field(default_factory=lambda: np.zeros(3), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        strain = np.zeros_like(truth.force)
        for i in range(3):
            strain[:, i] = play(truth.force[:, i], HALF_WIDTH, float(self._played[i]))
        self._played = strain[-1]
        return Reading.of_gyros(self.value * strain / (STANDARD_GRAVITY - HALF_WIDTH))
