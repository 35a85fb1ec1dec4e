"""Vibration rectification of the accelerometers."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import Instants
from laboratory.sensor import Reading, Sensors
from laboratory.truth import Truth
from laboratory.units import MICROGRAVITY, STANDARD_GRAVITY


@dataclass(frozen=True)
class AccelVibrationRectification(Effect):
    """While the table is shaken, f̃_i += v + k_i σ²: a white vibration and its bias.

    coefficient: k, (3,), (m/s²)/(m/s²)²; vibration: σ, m/s², standard deviation of a sample,
    independent for each axis; start, end: s since the campaign's first sample.
    Source: IEEE Std 1293-2018, "vibration rectification error".
    """

    coefficient: Array
    vibration: float
    start: float
    end: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        unit = MICROGRAVITY / STANDARD_GRAVITY**2
        return cls(
            np.array(parameters["k_micro_g_g2"], dtype=float) * unit,
            parameters["vibration_g"] * STANDARD_GRAVITY,
            parameters["from_s"],
            parameters["to_s"],
        )

    def shaken(self, instants: Instants) -> Array:
        """1 during the vibration, (m,)."""
        return instants.since(self.start) - instants.since(self.end)

    def reading_error(self, truth: Truth, sensors: Sensors) -> Reading:
        shift = self.coefficient * self.vibration**2
        return Reading.of_accelerometers(self.shaken(truth.motion.instants)[:, None] * shift)

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading:
        instants = truth.motion.instants
        seconds = instants.integral(self.shaken(instants))[:, None]
        noise = generator.standard_normal((instants.samples, 3))
        return Reading.of_accelerometers(self.vibration * seconds * noise)
