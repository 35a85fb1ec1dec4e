"""Outliers: single wrong readings."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Spikes(Fault):
    """In each of `lines` one channel reads `size` too much, m/s² or rad/s, in whole counts."""

    name: ClassVar[str] = "spikes"
    channel: int
    size: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            in_its_unit(parameters, "size"),
        )

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        counts = records.counts.copy()
        counts[rows, self.channel] += int(np.rint(self.size / records.units[self.channel]))
        return replace(records, counts=counts).marked(self.name, rows)
