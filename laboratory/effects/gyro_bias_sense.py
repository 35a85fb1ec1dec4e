"""Gyros that stay magnetised by the last turn: a bias with its sense."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import relay
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR

FLIPS = np.array([2.0, 3.0, 4.0, 5.0]) * DEGREE  # rad/s, at which the domains turn over


@dataclass
class GyroBiasSense(ArrayEffect):
    """ω̃_i += b_i · mean of m_k(ω_i), m_k = ±1 the relay that flips at ±w_k, at first 0.

    Domains of a core, each of which turns over at its own field, here that of the rate (Preisach):
    b in a turn forwards and after it, −b in one backwards and after it.
    value: b, (3,), rad/s.
    Source: F. Preisach, Z. Phys. 94, 1935, 277.
    """

    KEY = "offset_deg_h"
    UNIT = DEGREE / HOUR

    _domains: Array = field(default_factory=lambda: np.zeros((3, len(FLIPS))), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        rate = sensors.gyro.project(truth.rate)
        magnetised = np.zeros_like(rate)
        for i, k in np.ndindex(self._domains.shape):
            domain = relay(rate[:, i], float(FLIPS[k]), float(self._domains[i, k]))
            self._domains[i, k] = domain[-1]
            magnetised[:, i] += domain / len(FLIPS)
        return Reading.of_gyros(self.value * magnetised)
