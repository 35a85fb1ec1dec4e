"""Oscillation of a channel."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.counts import count
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records


@dataclass(frozen=True)
class Oscillate(Fault):
    """A sin(2πf t) on one channel, t from the start of the sample of `line`.

    A: amplitude, m/s² or rad/s; f: frequency, Hz. A sample gets the mean over its interval, exact:
    A (cos 2πf t₀ − cos 2πf t₁) / (2πf Δt), t₀ and t₁ its true ends, independent of the
    stamps. The rounding error of a count is carried to the next sample.
    """

    name: ClassVar[str] = "oscillate"
    channel: int
    frequency: float
    amplitude: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            parameters["frequency_hz"],
            in_its_unit(parameters, "amplitude"),
        )

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        dt, angular = records.interval, 2 * pi * self.frequency
        start = (records.ends[rows] - records.ends[rows[0]]) / NANOSECONDS
        difference = np.cos(angular * start) - np.cos(angular * (start + dt))
        mean = self.amplitude * difference / (angular * dt)
        counts = records.counts.copy()
        counts[rows, self.channel] += count(np.cumsum(mean), records.units[self.channel])
        return replace(records, counts=counts).marked(self.name, rows)
