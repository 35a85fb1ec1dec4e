"""Horizontal vibration of the table: noise of the horizontal axes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.effects.effect import Effect
from laboratory.instants import NODES_PER_INTERVAL
from laboratory.rotation import seen_from
from laboratory.sensor import Reading
from laboratory.truth import Truth
from laboratory.units import ROOT_HOUR


@dataclass(frozen=True)
class TableSway(Effect):
    """Random horizontal vibration: every velocity increment has the variance N² dt.

    density: N towards east, north and up, (3,), (m/s)/√s, none towards up. An accelerometer senses
    the component along its axis at the end of the sample, so a vertical one senses nothing; the
    mounting is neglected, a hundredth of it. Observed in S0, tables 5-3 and 5-4: 6 to 9 mm/s² per
    10 ms on a horizontal y axis, 1 mm/s² on a vertical one, which is 0.04 to 0.05 m/s/√h.
    """

    density: Array

    @classmethod
    def specified(cls, noise: Mapping[str, Any]) -> Self:
        east, north = noise.get("table_sway_m_s_sqrt_h", (0.0, 0.0))
        return cls(np.array([east, north, 0.0]) / ROOT_HOUR)

    def noise(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        if not self.density.any():
            return None
        instants = truth.motion.instants
        velocity = (
            self.density
            * np.sqrt(instants.interval)
            * generator.standard_normal((instants.samples, 3))
        )
        ends = truth.motion.attitude[NODES_PER_INTERVAL::NODES_PER_INTERVAL]
        return Reading(seen_from(ends, velocity), np.zeros_like(velocity))
