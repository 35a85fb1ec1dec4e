"""Hysteresis of the accelerometers: a bias that depends on the forces before."""

from dataclasses import dataclass, field

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import ArrayEffect
from laboratory.memory import play
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY

HALF_WIDTHS = (np.arange(10) + 0.5) / 10 * STANDARD_GRAVITY  # m/s², of the play operators


@dataclass
class AccelHysteresis(ArrayEffect):
    """f̃_i += (4 h_i / g) (mean of p_r(f_i) − f_i/2), p_r the play operator of half width r.

    Dry friction in many small contacts: a material without elastic threshold, evenly many of which
    give way at each force up to g (the operator of Prandtl and Ishlinskii). Between forces of ±g
    the loop is closed at its ends and ±h wide at zero; after smaller forces it is narrower. At
    first no contact is loaded.
    value: h, (3,), m/s².
    Source: P. Krejčí and K. Kuhnen, IEE Proc. Control Theory Appl. 148, 2001, 185.
    """

    KEY = "offset_micro_g"
    UNIT = MICROGRAVITY

    _played: Array = field(default_factory=lambda: np.zeros((3, len(HALF_WIDTHS))), init=False)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        force = sensors.accelerometer.project(truth.force)
        mean = np.zeros_like(force)
        for i, k in np.ndindex(self._played.shape):
            played = play(force[:, i], float(HALF_WIDTHS[k]), float(self._played[i, k]))
            self._played[i, k] = played[-1]
            mean[:, i] += played / len(HALF_WIDTHS)
        return Reading.of_accelerometers(4 / STANDARD_GRAVITY * self.value * (mean - force / 2))
