"""Jump of the bias of a channel."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from laboratory.channels import column, in_its_unit
from laboratory.counts import count
from laboratory.faults.fault import Fault
from laboratory.faults.lines import Lines
from laboratory.records import Records


@dataclass(frozen=True)
class Step(Fault):
    """From `line` on one channel reads `size` more, m/s² or rad/s.

    The rounding error of a count is carried to the next sample.
    """

    name: ClassVar[str] = "step"
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
        running = self.size * np.arange(1.0, len(rows) + 1)
        counts = records.counts.copy()
        counts[rows, self.channel] += count(running, records.units[self.channel])
        return replace(records, counts=counts).marked(self.name, rows)
