"""A table that sways: noise that only the level axes see."""

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
    """The table shakes level: every increment of velocity scatters with the variance N² dt.

    level: N towards east, north and up, (3,), (m/s)/√s, none towards up. An accelerometer feels
    what falls along its axis at the end of the sample, so one that points up feels nothing; the
    mounting is left out, a hundredth of it. Seen in S0, tables 5-3 and 5-4: 6 to 9 mm/s² per 10 ms
    on a level y axis beside 1 mm/s² on an upright one, which is 0.04 to 0.05 m/s/√h.
    """

    level: Array

    @classmethod
    def specified(cls, noise: Mapping[str, Any]) -> Self:
        east, north = noise.get("table_sway_m_s_sqrt_h", (0.0, 0.0))
        return cls(np.array([east, north, 0.0]) / ROOT_HOUR)

    def scatters(self, truth: Truth, generator: np.random.Generator) -> Reading | None:
        if not self.level.any():
            return None
        instants = truth.motion.instants
        velocity = (
            self.level
            * np.sqrt(instants.interval)
            * generator.standard_normal((instants.samples, 3))
        )
        ends = truth.motion.attitude[NODES_PER_INTERVAL::NODES_PER_INTERVAL]
        return Reading(seen_from(ends, velocity), np.zeros_like(velocity))
