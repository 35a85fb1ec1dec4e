"""Hysteresis of the gyros: dry friction, which depends on the rates before."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import play
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR

YIELDS = np.array([2.0, 3.0, 4.0, 5.0]) * DEGREE  # rad/s, at which the springs begin to slip


@dataclass
class GyroHysteresis(ArrayEffect):
    """ω̃_i −= h_i · mean of s_k(ω_i), s_k = (ω − p_k(ω)) / w_k, p_k the play of half width w_k.

    Springs in parallel, each in series with a dry slider that slips at its own yield w_k (Iwan).
    While the rate rises all of them pull back, while it falls they push: 2 h between the two
    courses of a large loop. At rest h after a turn forwards, −h after one backwards; at first none
    is loaded.
    value: h, (3,), rad/s.
    Source: W. D. Iwan, J. Appl. Mech. 33, 1966, 893.
    """

    KEY = "offset_deg_h"
    UNIT = DEGREE / HOUR

    _played: Array = field(default_factory=lambda: np.zeros((3, len(YIELDS))), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        pull = np.zeros_like(rate)
        for i, k in np.ndindex(self._played.shape):
            played = play(rate[:, i], float(YIELDS[k]), float(self._played[i, k]))
            self._played[i, k] = played[-1]
            pull[:, i] += (rate[:, i] - played) / (YIELDS[k] * len(YIELDS))
        return Reading.of_gyros(-self.value * pull)
