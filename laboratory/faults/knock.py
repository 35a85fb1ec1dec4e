"""Impact on the case."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.arrays import Array
from laboratory.counts import count
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records


@dataclass(frozen=True)
class Knock(Fault):
    """A blow from `line` on: velocity and angle of the case ring and decay, nothing remains.

    Each channel adds to its running integral a P / (2πf) e^(−t/τ) sin(2πf t), t from the start of
    the sample of `line`; P: the greatest amplitude, m/s² or rad/s; a: a random share from −1 to 1.
    """

    name: ClassVar[str] = "knock"
    peaks: Array  # (6,), m/s² and rad/s
    frequency: float
    decay: float  # s

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            np.repeat([float(parameters["peak_m_s2"]), float(parameters["peak_rad_s"])], 3),
            parameters["frequency_hz"],
            parameters["decay_s"],
        )

    def change_randomly(self, records: Records, generator: np.random.Generator) -> Records:
        rows = self.lines.rows(len(records))
        angular = 2 * pi * self.frequency
        end = (records.ends[rows] - records.ends[rows[0]]) / NANOSECONDS + records.interval
        ringing = np.exp(-end / self.decay) * np.sin(angular * end) / angular  # s
        sums = ringing[:, None] * self.peaks * generator.uniform(-1, 1, 6)
        counts = records.counts.copy()
        counts[rows] += count(sums, records.units * records.interval)
        changed = np.flatnonzero((counts != records.counts).any(axis=1))
        return replace(records, counts=counts).marked(self.name, changed)
