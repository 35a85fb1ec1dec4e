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

    The rounding error of a count is carried to the next sample. Half a count is rounded either way
    by chance: by one rule it would be at regular intervals, and those a tone that no IMU has.
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
        unit = records.units[self.channel]
        chance = np.random.default_rng([self.channel, int(rows[0])])
        running = self.size * np.arange(1.0, len(rows) + 1)
        running += unit * chance.uniform(-0.5, 0.5, len(rows))
        counts = records.counts.copy()
        counts[rows, self.channel] += count(running, unit)
        return replace(records, counts=counts).marked(self.name, rows)
