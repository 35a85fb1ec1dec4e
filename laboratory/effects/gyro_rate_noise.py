"""Noise of the gyros in proportion to the rate."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.truth import Truth


@dataclass(frozen=True)
class GyroRateNoise(Effect):
    """A scale factor with white noise: increments of the variance (k_i ω_i)² dt.

    relative: k, (3,), √s. It adds up in the angle of a turn, as jitter of the table does not.
    """

    relative: Array

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(1e-6 * np.array(parameters["relative_ppm_sqrt_s"], dtype=float))

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading:
        root = sqrt(truth.motion.instants.interval)
        rate = truth.turned / truth.motion.instants.interval
        drawn = generator.standard_normal(truth.turned.shape)
        return Reading.of_gyros(self.relative * np.abs(rate) * root * drawn)
