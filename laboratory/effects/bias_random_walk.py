"""Biases that wander: rate random walk of the gyros, and the accelerometers' likewise."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import sqrt
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import DEGREE, HOUR, ROOT_HOUR


@dataclass
class BiasRandomWalk(Effect):
    """The bias is integrated white noise: its variance grows by K² per second, from 0 at time 0.

    rate: K of the gyros, (rad/s)/√s; force: of the accelerometers, (m/s²)/√s; the same for the
    three axes. It continues in the pauses between the logs.
    Source: IEEE Std 952-2020, annex on noise models, "rate random walk".
    """

    rate: float
    force: float
    _reached: float = field(default=0.0, init=False)  # s, the end of the last segment
    _bias: Array = field(default_factory=lambda: np.zeros(6), init=False)  # in units of K

    @classmethod
    def specified(cls, noise: Mapping[str, Any]) -> Self:
        return cls(
            noise["gyro_rate_random_walk_deg_h_sqrt_h"] * DEGREE / HOUR / ROOT_HOUR,
            noise["accelerometer_random_walk_m_s2_sqrt_h"] / ROOT_HOUR,
        )

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        if self.rate == 0 and self.force == 0:
            return None
        instants = truth.motion.instants
        start, interval = instants.start, instants.interval
        pause = max(0.0, start - self._reached)
        at_start = self._bias + sqrt(pause) * generator.standard_normal(6)
        step, within = generator.standard_normal((2, instants.samples, 6))
        ends = at_start + sqrt(interval) * np.cumsum(step, axis=0)
        starts = np.vstack([at_start, ends[:-1]])
        # The integral of a Brownian path over an interval, given its increment √dt · step.
        path = starts * interval + interval**1.5 * (step / 2 + within / sqrt(12))
        self._reached, self._bias = start + instants.samples * interval, ends[-1]
        return Reading(self.force * path[:, :3], self.rate * path[:, 3:])
