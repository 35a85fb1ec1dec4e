"""Slip of the IMU in its fixture, which the gyros see."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.rotation import rotation_about, seen_from
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import ARCSECOND


@dataclass(frozen=True)
class MountingSlip(Effect):
    """From a moment on the case turns by φ at an even rate: it senses Rᵀ f and Rᵀ ω + φ/T.

    axis, angle: of φ, a unit vector (3,) of the body, and rad; moment, lasting: s, since the
    campaign's first sample, and T.
    """

    axis: Array
    angle: float
    moment: float
    lasting: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        vector = np.array(parameters["rotation_arcsec"], dtype=float) * ARCSECOND
        angle = float(np.linalg.norm(vector))
        axis = vector / angle if angle else np.eye(3)[0]
        return cls(axis, angle, parameters["at_s"], parameters["lasting_s"])

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        instants = truth.motion.instants
        end = self.moment + self.lasting
        slipping = (instants.since(self.moment) - instants.since(end))[:, None] / self.lasting
        done = np.clip((truth.time - self.moment) / self.lasting, 0.0, 1.0)
        turned = rotation_about(self.axis, done * self.angle)
        force, rate = (seen_from(turned, v) - v for v in (truth.force, truth.rate))
        rate = rate + slipping * self.angle * self.axis
        return Reading(sensors.accelerometer.project(force), sensors.gyro.project(rate))
