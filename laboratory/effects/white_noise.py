"""White noise of the sensors: angle random walk and velocity random walk."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any, Self

import numpy as np

from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import DEGREE, ROOT_HOUR


@dataclass(frozen=True)
class WhiteNoise(Effect):
    """Every increment has noise of the variance N² dt, at any sample rate.

    angle: rad/√s; velocity: (m/s)/√s; the same for the three axes.
    Source: IEEE Std 952-2020, annex on noise models, "angle random walk".
    """

    angle: float
    velocity: float

    @classmethod
    def specified(cls, noise: Mapping[str, Any]) -> Self:
        return cls(
            noise["angle_random_walk_deg_sqrt_h"] * DEGREE / ROOT_HOUR,
            noise["velocity_random_walk_m_s_sqrt_h"] / ROOT_HOUR,
        )

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading:
        root = sqrt(truth.motion.instants.interval)
        velocity, angle = generator.standard_normal((2, *truth.turned.shape))
        return Reading(self.velocity * root * velocity, self.angle * root * angle)
