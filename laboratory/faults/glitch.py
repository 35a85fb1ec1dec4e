"""A reading that is wrong once in every period of the clock."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.gps_time import NANOSECONDS
from laboratory.records import Records


@dataclass(frozen=True)
class Glitch(Fault):
    """One channel reads `size` more, m/s² or rad/s, in the record stamped nearest to `phase`.

    period, phase: ns; the stamp, ns of GPS time, modulo the period. In whole counts.
    """

    name: ClassVar[str] = "glitch"
    channel: int
    period: int
    phase: int
    size: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            round(parameters["period_s"] * NANOSECONDS),
            round(parameters["phase_s"] * NANOSECONDS),
            in_its_unit(parameters, "size"),
        )

    def change(self, records: Records) -> Records:
        interval = round(records.interval * NANOSECONDS)
        away = (records.stamps - self.phase + interval // 2) % self.period
        own = self.lines.rows(len(records))
        rows = own[away[own] < interval]
        counts = records.counts.copy()
        counts[rows, self.channel] += int(np.rint(self.size / records.units[self.channel]))
        return replace(records, counts=counts).marked(self.name, rows)
