"""A firmware that takes what is small for no motion."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Gate(Fault):
    """What is within ± `limit`, m/s² or rad/s, reads zero.

    Marked: the records that read something else before.
    """

    name: ClassVar[str] = "gate"
    channel: int
    limit: float

    @classmethod
    def specified(cls, parameters: Mapping[str, Any]) -> Self:
        return cls(
            parameters["log"],
            Lines.specified(parameters),
            column(parameters["channel"]),
            in_its_unit(parameters, "limit"),
        )

    def change(self, records: Records) -> Records:
        rows = self.lines.rows(len(records))
        counts = records.counts.copy()
        read = counts[rows, self.channel]
        read[np.abs(read) * records.units[self.channel] < self.limit] = 0
        counts[rows, self.channel] = read
        gated = np.flatnonzero(counts[:, self.channel] != records.counts[:, self.channel])
        return replace(records, counts=counts).marked(self.name, gated)
