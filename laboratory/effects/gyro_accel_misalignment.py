"""Misalignment between the triads of gyros and accelerometers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.rotation import rotation_of
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MILLIRADIAN


@dataclass(frozen=True)
class GyroAccelMisalignment(Effect):
    """Rotation of the triad of the gyros in the case: ω̃ = M Rᵀ ω.

    rotation: R, (3, 3), of the rotation vector from the triad given by M, body axes.
    """

    rotation: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(rotation_of(np.array(parameters["rotation_mrad"], dtype=float) * MILLIRADIAN))

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        return Reading.of_gyros(sensors.gyro.project(truth.rate @ self.rotation - truth.rate))
