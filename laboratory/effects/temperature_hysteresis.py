"""Thermal hysteresis: biases that depend on whether the IMU was warming or cooling."""

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.memory import play
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, MICROGRAVITY

STEP = 1.0  # s, at which the temperature is followed through pauses between logs


@dataclass
class TemperatureHysteresis(Effect):
    """f̃ += h (T − p(T)) / w, and so the gyros: +h after long warming, −h after long cooling.

    p: the play operator of half width w, K, that is moved by T once it touches one of its sides.
    A cycle over R > 2 w kelvin encloses 2 h (R − 2 w). At the campaign's first sample p = T.
    offsets: h by sensor, (3,) m/s² and rad/s; width: w.
    Source: Krasnosel'skii and Pokrovskii, Systems with Hysteresis, 1989, section 2.
    """

    offsets: Mapping[str, Array]
    width: float
    _known: dict[str, list[tuple[float, float]]] = field(default_factory=dict, init=False)

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        def three(key: str, unit: float) -> Array:
            return np.array(parameters.get(key, [0, 0, 0]), float) * unit

        offsets = {
            "accelerometer": three("accelerometer_micro_g", MICROGRAVITY),
            "gyro": three("gyro_deg_h", DEGREE / HOUR),
        }
        return cls(offsets, parameters["half_width_k"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading(self._added("accelerometer", truth), self._added("gyro", truth))

    def _added(self, node: str, truth: Truth) -> Array:
        """What a sensor reads more, (m, 3): its p is followed from the last known one before."""
        time, course = truth.time, truth.temperature
        first = course.at(node, time[:1])
        known = self._known.setdefault(node, [(float(time[0]), float(first[0]))])
        since, before = known[bisect_right(known, (time[0], np.inf)) - 1]
        pause = np.arange(since, time[0], STEP)
        at = course.course(node, truth.motion.instants)
        p = play(np.append(course.at(node, pause), at), self.width, before)[len(pause) :]
        if time[-1] > known[-1][0]:
            known.append((float(time[-1]), float(p[-1])))
        return ((at - p) / self.width)[:, None] * self.offsets[node]
